// SPDX-License-Identifier: BSD-3-Clause
//
// The camera's pose from the vehicle's, over a level floor.
//
//   h       = altitude + altitude_offset_m
//   d       = (-sin p, cos p sin q, cos p cos q)     the way down, seen from the vehicle
//   H       = h d_z       altitude_is axis: along the vehicle's own z
//           = h           plumb, nearest
//   R       = Rz(yaw) Ry(pitch) Rx(roll)             from the camera's frame to the vehicle's
//   c       = R^T d                                  the way down, seen from the camera
//   camera's altitude, along its axis  = (H - d . position_m) / c_z
//            pitch                     = -asin c_x
//            roll                      = atan2(c_y, c_z)
//
// p, q: the vehicle's pitch, positive bow up, and roll, positive starboard down [rad]. The frames
// of vehicle and camera coincide for R = 1: x forward, the top row; y starboard; z down, the axis.
// Rotations are right-handed, first about z, then about the rotated y and x.
//
// If the camera is at the vehicle's origin, not rotated, its pose is exactly the vehicle's except
// for the altitude, and with `axis` and no offset the altitude's, too. Level, at 2 m, a camera 0.5
// m below the origin and pitched up by 60 degrees is at 1.5 m / cos(60 deg) = 3 m.
//
// The floor has no slope, so its nearest point is straight below: `plumb` and `nearest` are the
// same number here. On a slope of s they differ by cos s: 1.5 % at 10 degrees.
#pragma once

#include "rig/rig.h"

namespace aphotic {

// Whether the camera's position or orientation differs from the vehicle's.
[[nodiscard]] bool is_mounted_apart(const Mounting& mounting);

// An InputError with its numbers if the camera's axis does not meet the floor, or the camera would
// be below it.
[[nodiscard]] Sled camera_pose(const Sled& vehicle, const Mounting& mounting);

// The vehicle's pose for this camera's, as written to the navigation. An InputError if the
// vehicle's own z does not meet the floor.
[[nodiscard]] Sled vehicle_pose(const Sled& camera, const Mounting& mounting);

}  // namespace aphotic
