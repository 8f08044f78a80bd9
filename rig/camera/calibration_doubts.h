// SPDX-License-Identifier: BSD-3-Clause
//
// Likely mistakes in a calibration that is otherwise valid. Each is a sentence with the number, the
// usual range and a possible cause.
//
//   the principal point       further from the image's middle than 20 % of its width or height
//   fx / fy                   below 0.5 or over 2
//   the field of view across  below 2 degrees, or over 150 (a fisheye's: 200)
//
//   rectilinear: 2 atan(w / (2 fx))        fisheye: w / fx         w: the image's width in pixels
#pragma once

#include "rig/camera/lens_model.h"

#include <string>
#include <vector>

namespace aphotic {

[[nodiscard]] std::vector<std::string> calibration_doubts(const LensModel& lens,
                                                          int width_px,
                                                          int height_px);

}  // namespace aphotic
