// SPDX-License-Identifier: BSD-3-Clause
//
// A frame that POV-Ray wrote as 16-bit PNG, as the EXR that all others are.
#pragma once

#include <filesystem>

namespace aphotic {

// What is 1 may have been more, unless the frame's light ends there, as fog does.
enum class White { IsClipped, IsWhite };

// From FILE.png, as POV-Ray calls it whom FILE tells no format, to FILE. Samples are linear and
// become floats, exactly; the PNG goes. A RunError where it cannot be read, or a pixel is clipped.
void exr_of_png_frame(const std::filesystem::path& file, White white);

}  // namespace aphotic
