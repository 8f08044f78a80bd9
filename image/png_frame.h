// SPDX-License-Identifier: BSD-3-Clause
//
// Converts a frame that POV-Ray wrote as 16-bit PNG to an EXR like all others.
#pragma once

#include <filesystem>

namespace aphotic {

// A sample of 1 may have been clipped, unless the frame's light is limited to 1, as fog is.
enum class White { IsClipped, IsWhite };

// From FILE.png, POV-Ray's name for an output file without a format, to FILE. Samples are linear
// and become floats, exactly; the PNG is removed. A RunError if it cannot be read or a pixel is
// clipped.
void exr_of_png_frame(const std::filesystem::path& file, White white);

}  // namespace aphotic
