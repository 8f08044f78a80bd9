// SPDX-License-Identifier: BSD-3-Clause
//
// "1 frame", "2 frames".
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace aphotic::cli {

[[nodiscard]] inline std::string counted(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace aphotic::cli
