// SPDX-License-Identifier: BSD-3-Clause
//
// What is left of the disk where a folder is or will be made.
#pragma once

#include <cstdint>
#include <filesystem>

namespace aphotic {

// The folder's own disk, or that of the nearest folder above it that is there.
[[nodiscard]] std::uint64_t free_disk_bytes(const std::filesystem::path& folder);
[[nodiscard]] bool on_one_disk(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace aphotic
