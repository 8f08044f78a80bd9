// SPDX-License-Identifier: BSD-3-Clause
//
// Headers of OpenEXR files, read by OpenEXRCore and judged before OpenEXR reads the image: that
// takes the sizes there at their word and asks for gigabytes on a damaged one.
//
// Accepted: headers that OpenEXRCore finds to be as the standard has them, images of up to
// kLargestImagePx each way, tiles that hold little more than the image, no deep pixels, and a first
// part whose data window, the pixels that are there, is its display window, the image. Where the
// windows differ, the file is a part of its image or has more around it, and pixels would be taken
// for others; a common origin other than 0, 0 changes nothing.
#pragma once

#include <filesystem>

namespace aphotic {

// By its first bytes.
[[nodiscard]] bool is_exr(const std::filesystem::path& file);

// An InputError that does not name the file.
void require_sound_exr_header(const std::filesystem::path& file);

}  // namespace aphotic
