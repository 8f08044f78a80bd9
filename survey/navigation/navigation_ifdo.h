// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation from an image set's iFDO (ifdo.h), of each image or as a default of all:
//
//   image-meters-above-ground     h, the camera's height over the sea floor, plumb
//   image-camera-pitch-degrees    p, positive bow up
//   image-camera-roll-degrees     r, positive starboard down
//
// which are the camera's own: nothing is to be added for its place on a vehicle. With yaw, pitch
// and roll turned in this order the axis dips by cos p cos r, and the altitude of a pose, which is
// along the axis, is h / (cos p cos r). Angles that no image has are the rig's.
//
// image-altitude-meters is over sea level, negative in the sea, and never taken.
#pragma once

#include "survey/navigation/ifdo.h"
#include "survey/navigation/navigation.h"

#include <string>
#include <string_view>

namespace aphotic {

inline constexpr const char* kIfdoHeight = "image-meters-above-ground";
inline constexpr const char* kIfdoPitch = "image-camera-pitch-degrees";
inline constexpr const char* kIfdoRoll = "image-camera-roll-degrees";

// name stands in messages. An InputError when it is no iFDO, or tells no height of any image.
[[nodiscard]] Navigation parse_navigation_ifdo(const std::string& name,
                                               std::string_view text,
                                               const Sled& rig_sled);

}  // namespace aphotic
