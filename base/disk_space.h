// SPDX-License-Identifier: BSD-3-Clause
//
// Free space on the disk where a folder is or will be made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace aphotic {

// The folder's own disk, or that of its nearest existing parent.
[[nodiscard]] std::uint64_t free_disk_bytes(const std::filesystem::path& folder);
[[nodiscard]] bool on_one_disk(const std::filesystem::path& a, const std::filesystem::path& b);

// Whether the disk was full while POV-Ray wrote to it; POV-Ray exits normally even if it cannot
// write its image or log. A line to follow another message, or empty: "\nDIR: No space left on
// device: 3 KiB left".
[[nodiscard]] std::string words_of_full_disk(const std::filesystem::path& folder);

}  // namespace aphotic
