// SPDX-License-Identifier: BSD-3-Clause
//
// What the machine has left: of disk where a folder is or will be made, and of memory.
//
// Memory is what Linux says it can give without swapping, MemAvailable of /proc/meminfo, or the
// whole limit of the control group that we run in, or that of a process (ulimit -v, ulimit -d),
// whichever is least. (Of a group's limit the caches count as used, so what is left of it says too
// little.) A machine that tells neither is
// taken to have any amount.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string_view>

namespace aphotic {

inline constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

// The folder's own disk, or that of the nearest folder above it that is there.
[[nodiscard]] std::uint64_t free_disk_bytes(const std::filesystem::path& folder);
[[nodiscard]] bool on_one_disk(const std::filesystem::path& a, const std::filesystem::path& b);

[[nodiscard]] std::uint64_t free_memory_bytes();

// Of the texts of /proc/meminfo and of a control group's memory.max.
[[nodiscard]] std::uint64_t available_bytes(std::string_view meminfo);
[[nodiscard]] std::uint64_t limit_bytes(std::string_view memory_max);

}  // namespace aphotic
