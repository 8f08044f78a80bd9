// SPDX-License-Identifier: BSD-3-Clause
//
// A floor of hills as an image sees it, in closed form:
//
//   z = h + a sin(k x + p) sin(k y + q)     x, y, z in the sled's frame
#pragma once

#include "light/relief.h"
#include "lightmap/relief_map.h"

#include <cmath>

namespace aphotic {

struct Hills {
    double depth_m = 2.0;    // h
    double height_m = 0.05;  // a
    double k_per_m = 6.0;
    double p_rad = 0.0;
    double q_rad = 0.0;

    [[nodiscard]] double z_m(double x_m, double y_m) const {
        return depth_m +
               height_m * std::sin(k_per_m * x_m + p_rad) * std::sin(k_per_m * y_m + q_rad);
    }
    // On the side of the camera.
    [[nodiscard]] Eigen::Vector3d normal(double x_m, double y_m) const {
        const double x_rad = k_per_m * x_m + p_rad;
        const double y_rad = k_per_m * y_m + q_rad;
        const double slope = height_m * k_per_m;
        return Eigen::Vector3d(slope * std::cos(x_rad) * std::sin(y_rad),
                               slope * std::sin(x_rad) * std::cos(y_rad),
                               -1.0)
            .normalized();
    }
};

inline Relief relief_of(const Hills& hills,
                        const ReliefMapMaker& rays,
                        int width_px,
                        int height_px) {
    Relief relief{.width_px = width_px, .height_px = height_px};
    for (int row = 0; row < height_px; ++row) {
        for (int column = 0; column < width_px; ++column) {
            const WaterRay ray = rays.ray(column + 0.5, row + 0.5);
            Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
            constexpr int kRounds = 60;  // each brings it nearer by the slopes of ray and floor
            for (int round = 0; round < kRounds; ++round)
                point_m = ray.origin_m + (hills.z_m(point_m.x(), point_m.y()) - ray.origin_m.z()) /
                                             ray.direction.z() * ray.direction;
            relief.point_m.emplace_back(point_m.cast<float>());
            relief.normal.emplace_back(hills.normal(point_m.x(), point_m.y()).cast<float>());
        }
    }
    return relief;
}

}  // namespace aphotic
