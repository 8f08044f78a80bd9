// SPDX-License-Identifier: BSD-3-Clause
//
// Poses from stereo_pose_est.data of the Australian Centre for Field Robotics (ACFR), of the AUV
// Sirius and its kin: fifteen words a line, without a header,
//
//   identifier time latitude longitude X Y Z phi theta psi left right altitude radius cross-over
//
// Each line tells of two images, left and right. phi, theta and psi (radians) turn north, east and
// down, in this order of axes, into the stereo frame: X right in the image, Y to its bottom, Z
// along the axis. So the way down has these parts in the camera's own frame, whose x runs to the
// image's top (vehicle_pose.h):
//
//   (x, y, z) = (-cos theta sin phi, -sin theta, cos theta cos phi)
//   pitch = -asin x        roll = atan2(y, z)
//
// phi = 0.0873, theta = 0: pitch 5.002 degrees, roll 0. The altitude is the vehicle's, 0 where its
// altimeter lost the floor.
//
// Source: the comments that seabed_slam and oplab_pipeline (auv_nav, parse_acfr_stereo_pose.py)
// write into these files.
#pragma once

#include "survey/navigation.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

// Fifteen words, numbers but for the two names.
[[nodiscard]] bool is_acfr_line(const std::vector<std::string>& words);

// Of a line, be it one of these or not: that is the poses' fault.
[[nodiscard]] std::array<ImagePose, 2> acfr_poses(const std::vector<std::string>& words,
                                                  std::size_t line);

}  // namespace aphotic
