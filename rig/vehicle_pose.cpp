// SPDX-License-Identifier: BSD-3-Clause
#include "rig/vehicle_pose.h"

#include "base/degrees.h"
#include "base/error.h"
#include "rig/geometry.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// For the frame in which this is the downward direction.
double pitch_of(const Vector3d& down) {
    return -std::asin(std::clamp(down.x(), -1.0, 1.0));
}
double roll_of(const Vector3d& down) {
    return std::atan2(down.y(), down.z());
}

}  // namespace

Eigen::Matrix3d turn_by(const Vector3d& roll_pitch_yaw_rad) {
    return (Eigen::AngleAxisd(roll_pitch_yaw_rad.z(), Vector3d::UnitZ()) *
            Eigen::AngleAxisd(roll_pitch_yaw_rad.y(), Vector3d::UnitY()) *
            Eigen::AngleAxisd(roll_pitch_yaw_rad.x(), Vector3d::UnitX()))
        .toRotationMatrix();
}

bool is_mounted_apart(const Mounting& mounting) {
    return !mounting.position_m.isZero(0.0) || !mounting.roll_pitch_yaw_rad.isZero(0.0);
}

Sled camera_pose(const Sled& vehicle, const Mounting& mounting) {
    const Vector3d down = -floor_plane(vehicle).normal;
    const bool is_along_axis = mounting.altitude_is == AltitudeIs::Axis;
    const double altitude_m = vehicle.altitude_m + mounting.altitude_offset_m;
    if (!is_mounted_apart(mounting)) {
        return {is_along_axis ? altitude_m : altitude_m / down.z(),
                vehicle.pitch_rad,
                vehicle.roll_rad};
    }
    const Vector3d seen = turn_by(mounting.roll_pitch_yaw_rad).transpose() * down;
    if (seen.z() <= 0.0) {
        throw InputError(
            "the camera looks {:.3g} degrees above the horizon; allowed: below it, to see the "
            "floor",
            std::asin(std::min(-seen.z(), 1.0)) * kDegreesPerRadian);
    }
    const double vehicle_height_m = is_along_axis ? altitude_m * down.z() : altitude_m;
    const double height_m = vehicle_height_m - down.dot(mounting.position_m);
    if (height_m <= 0.0) {
        throw InputError(
            "the camera is {:.3g} m below the floor: the vehicle's origin is {:.3g} m above it, "
            "and the camera {:.3g} m lower",
            -height_m,
            vehicle_height_m,
            vehicle_height_m - height_m);
    }
    return {height_m / seen.z(), pitch_of(seen), roll_of(seen)};
}

Place camera_place(const Place& place, const Sled& vehicle, const Mounting& mounting) {
    if (!is_mounted_apart(mounting) || std::isnan(place.heading_rad)) return place;
    const Eigen::Matrix3d to_world =
        turn_by({vehicle.roll_rad, vehicle.pitch_rad, place.heading_rad});
    const Vector3d lever_m = to_world * mounting.position_m;
    const Vector3d ahead = to_world * turn_by(mounting.roll_pitch_yaw_rad).col(0);
    return {.east_m = place.east_m + lever_m.y(),
            .north_m = place.north_m + lever_m.x(),
            .heading_rad = std::atan2(ahead.y(), ahead.x()),
            .depth_m = place.depth_m + lever_m.z()};
}

Sled vehicle_pose(const Sled& camera, const Mounting& mounting) {
    const Vector3d seen = -floor_plane(camera).normal;
    const bool is_along_axis = mounting.altitude_is == AltitudeIs::Axis;
    if (!is_mounted_apart(mounting)) {
        return {(is_along_axis ? camera.altitude_m : camera.altitude_m * seen.z()) -
                    mounting.altitude_offset_m,
                camera.pitch_rad,
                camera.roll_rad};
    }
    const Vector3d down = turn_by(mounting.roll_pitch_yaw_rad) * seen;
    if (down.z() <= 0.0)
        throw InputError("found a pose in which the vehicle's z points up; allowed: down");
    const double height_m = camera.altitude_m * seen.z() + down.dot(mounting.position_m);
    return {(is_along_axis ? height_m / down.z() : height_m) - mounting.altitude_offset_m,
            pitch_of(down),
            roll_of(down)};
}

}  // namespace aphotic
