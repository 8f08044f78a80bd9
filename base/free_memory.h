// SPDX-License-Identifier: BSD-3-Clause
//
// The memory that programs may take now: what the kernel calls available, which counts caches that
// it would give up, or less where a control group (version 2) ends before, as a scheduler's job or
// a container does.
#pragma once

#include <cstdint>
#include <filesystem>

namespace aphotic {

// Of Linux; without bound where it is not told. root: of another machine's files, for tests.
[[nodiscard]] std::uint64_t free_memory_bytes(const std::filesystem::path& root = "/");

}  // namespace aphotic
