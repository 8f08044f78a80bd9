// SPDX-License-Identifier: BSD-3-Clause
//
// A rig in words, for the reader of a report: an HTML list of terms and sentences.
//
//   Sled    2 m above the floor, bow up by 5°, level athwartships.
#pragma once

#include "rig/rig.h"

#include <string>

namespace aphotic {

// scene_file: a scene of the user's own that POV-Ray rendered, which the reference does not read;
// empty: none.
[[nodiscard]] std::string rig_in_words(const Rig& rig, const std::string& scene_file = "");

// Where a point of the sled frame is, such as "0.5 m aft and 0.2 m up from the entrance pupil".
[[nodiscard]] std::string place_in_words(const Eigen::Vector3d& position_m);

// Which way a unit vector points, such as "26° off the camera’s axis, towards aft".
[[nodiscard]] std::string aim_in_words(const Eigen::Vector3d& axis);

}  // namespace aphotic
