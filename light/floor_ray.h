// SPDX-License-Identifier: BSD-3-Clause
//
// A ray of the image, the floor point that it meets, and the path of a lamp's light to it.
//
// A ray starts at o along the unit vector D. With `down` the unit vertical, H the height of o above
// the floor and w = down . D, it meets the floor at P = o + D H/w. Light from a lamp at s arrives
// along
//
//   V = w (P - s) = w (o - s) + H D
//
// a vector that stays finite towards the horizon.
//
// The scalar T is a number, or a number with derivatives (ceres::Jet) for a fit that moves the
// floor: rays and lamps are fixed to the sled.
#pragma once

#include "rig/geometry.h"

#include <Eigen/Core>

namespace aphotic {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <typename T>
struct BasicFloorRay {
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    T down = T(0.0);      // w
    T height_m = T(0.0);  // H

    [[nodiscard]] bool sees_floor() const { return down > 0.0 && height_m > 0.0; }
};
using FloorRay = BasicFloorRay<double>;

[[nodiscard]] inline FloorRay floor_ray(const WaterRay& ray, const Plane& floor) {
    return {.origin_m = ray.origin_m,
            .direction = ray.direction,
            .down = -floor.normal.dot(ray.direction),
            .height_m = height_above(floor, ray.origin_m)};
}

// V; 0 if the ray sees no floor.
template <typename T>
[[nodiscard]] Vector3<T> towards(const Eigen::Vector3d& lamp_m, const BasicFloorRay<T>& ray) {
    if (!ray.sees_floor()) return Vector3<T>::Zero();
    return ray.down * (ray.origin_m - lamp_m).template cast<T>() +
           ray.height_m * ray.direction.template cast<T>();
}

}  // namespace aphotic
