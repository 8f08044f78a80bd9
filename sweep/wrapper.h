// SPDX-License-Identifier: BSD-3-Clause
//
// Files that hand a sweep's tasks to the engines that run them (wrappers/).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace aphotic {

struct WrapperText {
    std::string_view name;
    std::string_view text;
};

// With the names of folder, tasks and cores for these.
[[nodiscard]] std::span<const WrapperText> wrapper_texts();

struct WrappedSweep {
    std::filesystem::path folder;  // absolute
    std::size_t tasks = 0;
    int cores = 1;
};
void write_wrappers(const WrappedSweep& sweep);

}  // namespace aphotic
