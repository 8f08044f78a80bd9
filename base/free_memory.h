// SPDX-License-Identifier: BSD-3-Clause
//
// The memory that programs may use now: the amount that the kernel reports as available, including
// reclaimable caches, or less if a control group (version 2) has a lower limit, as in a scheduler's
// job or a container.
#pragma once

#include <cstdint>
#include <filesystem>

namespace aphotic {

// Linux only; infinite if unknown. root: the files of another machine, for tests.
[[nodiscard]] std::uint64_t free_memory_bytes(const std::filesystem::path& root = "/");

}  // namespace aphotic
