// SPDX-License-Identifier: BSD-3-Clause
//
// The camera's pose from the vehicle's, over a level floor.
//
//   h       = altitude + altitude_offset_m
//   d       = (-sin p, cos p sin q, cos p cos q)     the downward direction in the vehicle's frame
//   H       = h d_z       altitude_is axis: along the vehicle's own z
//           = h           plumb, nearest
//   R       = Rz(yaw) Ry(pitch) Rx(roll)             from the camera's frame to the vehicle's
//   c       = R^T d                                  the downward direction in the camera's frame
//   camera's altitude, along its axis  = (H - d . position_m) / c_z
//            pitch                     = -asin c_x
//            roll                      = atan2(c_y, c_z)
//
// p, q: the vehicle's pitch, positive bow up, and roll, positive starboard down [rad]. The frames
// of vehicle and camera coincide for R = 1: x forward, the top row; y starboard; z down, the axis.
// Rotations are right-handed, first about z, then about the rotated y and x.
//
// If the camera is at the vehicle's origin and not rotated, its pose is exactly the vehicle's
// except for the altitude, and with `axis` and no offset the altitude as well. Level, at 2 m, a
// camera 0.5 m below the origin and pitched up by 60 degrees is at 1.5 m / cos(60 deg) = 3 m.
//
// In the world, with x north, y east, z down, camera and vehicle are given by their headings h,
// clockwise from north, and their places:
//
//   W                = Rz(h) Ry(p) Rx(q)             from the vehicle's frame to the world's
//   camera's place   = the vehicle's + W position_m
//            heading = atan2(f_y, f_x), f = W R x    of its top row
//
// The floor has no slope, so its nearest point is straight below: `plumb` and `nearest` are the
// same here. On a slope of s they differ by cos s: 1.5 % at 10 degrees.
#pragma once

#include "rig/rig.h"

#include <Eigen/Core>

#include <limits>

namespace aphotic {

// The place of a vehicle or its camera in the world, in the frame of a map projection or of the
// survey. NaN: not given.
struct Place {
    double east_m = std::numeric_limits<double>::quiet_NaN();
    double north_m = std::numeric_limits<double>::quiet_NaN();
    double heading_rad = std::numeric_limits<double>::quiet_NaN();
    double depth_m = std::numeric_limits<double>::quiet_NaN();  // below the sea level
};

// Rz(yaw) Ry(pitch) Rx(roll).
[[nodiscard]] Eigen::Matrix3d turn_by(const Eigen::Vector3d& roll_pitch_yaw_rad);

// Whether the camera's place or orientation differs from the vehicle's.
[[nodiscard]] bool is_mounted_apart(const Mounting& mounting);

// An InputError with its numbers if the camera's axis does not meet the floor, or the camera would
// be below it.
[[nodiscard]] Sled camera_pose(const Sled& vehicle, const Mounting& mounting);

// The camera's place, from that of the vehicle in this pose.
[[nodiscard]] Place camera_place(const Place& place, const Sled& vehicle, const Mounting& mounting);

// The vehicle's pose for this pose of the camera, as navigation reports it. An InputError if the
// vehicle's own z does not meet the floor.
[[nodiscard]] Sled vehicle_pose(const Sled& camera, const Mounting& mounting);

}  // namespace aphotic
