// SPDX-License-Identifier: BSD-3-Clause
//
// A ray of the image, the floor that it meets, and the way of a lamp's light there.
//
// A ray starts at o and goes along the unit vector D. With `down` the unit vertical, H the height
// of o over the floor and w = down . D, it meets the floor at P = o + D H/w. From a lamp at s the
// light comes along
//
//   V = w (P - s) = w (o - s) + H D
//
// a vector that stays finite towards the horizon.
#pragma once

#include "rig/geometry.h"

#include <Eigen/Core>

namespace aphotic {

struct FloorRay {
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    double down = 0.0;      // w
    double height_m = 0.0;  // H

    [[nodiscard]] bool sees_floor() const { return down > 0.0 && height_m > 0.0; }
};

[[nodiscard]] inline FloorRay floor_ray(const WaterRay& ray, const Plane& floor) {
    return {.origin_m = ray.origin_m,
            .direction = ray.direction,
            .down = -floor.normal.dot(ray.direction),
            .height_m = height_above(floor, ray.origin_m)};
}

// V; 0 where the ray sees no floor.
[[nodiscard]] inline Eigen::Vector3d towards(const Eigen::Vector3d& lamp_m, const FloorRay& ray) {
    if (!ray.sees_floor()) return Eigen::Vector3d::Zero();
    return ray.down * (ray.origin_m - lamp_m) + ray.height_m * ray.direction;
}

}  // namespace aphotic
