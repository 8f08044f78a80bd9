// SPDX-License-Identifier: BSD-3-Clause
//
// The sea floor as one image sees it, in place of a plane: the point that each pixel shows, and the
// normal there, in the sled's frame (rig/geometry.h). Unknown points are NaN.
//
// The floor jumps between two pixels if one lies off the plane through the other by more than
// kReliefJump of its distance, or if only one of them is known.
#pragma once

#include "rig/geometry.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr float kReliefJump = 0.02F;

struct Relief {
    int width_px = 0;
    int height_px = 0;
    std::vector<Eigen::Vector3f> point_m{};  // row by row
    std::vector<Eigen::Vector3f> normal{};   // unit, on the side of the camera

    [[nodiscard]] std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(column);
    }
    [[nodiscard]] bool knows(std::size_t pixel) const { return std::isfinite(point_m[pixel].z()); }
    // The tangent plane at the point.
    [[nodiscard]] Plane plane(std::size_t pixel) const {
        return {.point_m = point_m[pixel].cast<double>(), .normal = normal[pixel].cast<double>()};
    }
    [[nodiscard]] bool jumps(std::size_t pixel, std::size_t neighbour) const {
        if (knows(pixel) != knows(neighbour)) return true;
        const Eigen::Vector3f way = point_m[neighbour] - point_m[pixel];
        return std::abs(normal[pixel].dot(way)) > kReliefJump * point_m[pixel].norm();
    }
};

// Every nth of `count` places from the first on, and the last: at least two.
[[nodiscard]] inline std::vector<int> every(int step, int count) {
    std::vector<int> places{0};
    for (int place = step; place < count - 1; place += step) places.push_back(place);
    places.push_back(count - 1);
    return places;
}

}  // namespace aphotic
