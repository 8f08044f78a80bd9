// SPDX-License-Identifier: BSD-3-Clause
//
// What is left of the disk where a folder is or will be made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace aphotic {

// The folder's own disk, or that of the nearest folder above it that is there.
[[nodiscard]] std::uint64_t free_disk_bytes(const std::filesystem::path& folder);
[[nodiscard]] bool on_one_disk(const std::filesystem::path& a, const std::filesystem::path& b);

// Whether the disk was full while POV-Ray wrote to it, which ends well all the same when it cannot
// write its image or its log: a line to stand below another message, or nothing. "\nDIR: No space
// left on device: 3 KiB are left".
[[nodiscard]] std::string words_of_full_disk(const std::filesystem::path& folder);

}  // namespace aphotic
