// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation from an image set's iFDO (ifdo.h), for each image or as a default for all:
//
//   image-meters-above-ground     h, the camera's vertical height over the sea floor
//   image-camera-pitch-degrees    p, positive bow up
//   image-camera-roll-degrees     r, positive starboard down
//
// These are the camera's own: its mounting on a vehicle is already included. With yaw, pitch and
// roll applied in this order, the axis has the downward component cos p cos r, and the altitude
// of a pose, which is along the axis, is h / (cos p cos r). Angles that no image has are the rig's.
//
// image-altitude-meters is above sea level, negative in the sea, and never used.
#pragma once

#include "survey/navigation/ifdo.h"
#include "survey/navigation/navigation.h"

#include <string>
#include <string_view>

namespace aphotic {

inline constexpr const char* kIfdoHeight = "image-meters-above-ground";
inline constexpr const char* kIfdoPitch = "image-camera-pitch-degrees";
inline constexpr const char* kIfdoRoll = "image-camera-roll-degrees";

// name is for messages. An InputError if it is not an iFDO, or has no height for any image.
[[nodiscard]] Navigation parse_navigation_ifdo(const std::string& name,
                                               std::string_view text,
                                               const Sled& rig_sled);

}  // namespace aphotic
