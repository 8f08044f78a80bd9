// SPDX-License-Identifier: BSD-3-Clause
//
// What a ray meets first of a plane, a ball and a block, in closed form.
#pragma once

#include "rig/rig.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {

struct CastScene {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // unit; the plane is up . x = height_m
    double height_m = 0.0;
    Sphere ball{};
    Box block{};
};

struct CastHit {
    double way = std::numeric_limits<double>::infinity();  // in lengths of `along`
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();      // outwards
};

inline CastHit cast_ray(const CastScene& scene,
                        const Eigen::Vector3d& from_m,
                        const Eigen::Vector3d& along) {
    CastHit first;
    const auto take = [&](double way, const Eigen::Vector3d& normal) {
        if (way > 0.0 && way < first.way) first = {.way = way, .normal = normal};
    };
    take((scene.height_m - scene.up.dot(from_m)) / scene.up.dot(along), scene.up);

    const Eigen::Vector3d from_centre_m = from_m - scene.ball.centre_m;
    const double b = from_centre_m.dot(along) / along.squaredNorm();
    const double c = (from_centre_m.squaredNorm() - scene.ball.radius_m * scene.ball.radius_m) /
                     along.squaredNorm();
    if (b * b > c) {
        const double way = -b - std::sqrt(b * b - c);
        take(way, (from_centre_m + way * along) / scene.ball.radius_m);
    }

    double enters = -std::numeric_limits<double>::infinity();
    double leaves = std::numeric_limits<double>::infinity();
    Eigen::Vector3d face = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
        const double to_least = (scene.block.least_m[i] - from_m[i]) / along[i];
        const double to_most = (scene.block.most_m[i] - from_m[i]) / along[i];
        leaves = std::min(leaves, std::max(to_least, to_most));
        if (std::min(to_least, to_most) < enters) continue;
        enters = std::min(to_least, to_most);
        face = (along[i] > 0.0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(i);
    }
    if (enters < leaves) take(enters, face);
    return first;
}

}  // namespace aphotic
