// SPDX-License-Identifier: BSD-3-Clause
//
// Headers of OpenEXR files, read by OpenEXRCore and checked before OpenEXR reads the image: OpenEXR
// trusts their sizes and requests gigabytes for a damaged file.
//
// Accepted: headers that OpenEXRCore finds valid, images of up to kLargestImagePx each way, tiles
// that hold little more than the image, no deep pixels, and a first part whose data window, the
// pixels present, equals its display window, the image. If the windows differ, the file contains
// less or more than its image, and pixels would be misplaced; a common origin other than 0, 0 is
// accepted.
#pragma once

#include <filesystem>

namespace aphotic {

// Whether the first bytes are OpenEXR's.
[[nodiscard]] bool is_exr(const std::filesystem::path& file);

// An InputError that does not name the file.
void require_sound_exr_header(const std::filesystem::path& file);

}  // namespace aphotic
