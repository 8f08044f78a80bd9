// SPDX-License-Identifier: BSD-3-Clause
#include "light/tile_cone.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace aphotic {

using Eigen::Vector3d;

std::array<std::array<double, 2>, kTilePlaces> tile_places(int width, int height) {
    const double x = 0.5 * (width - 1);
    const double y = 0.5 * (height - 1);
    return {{{x, y},
             {0.0, 0.0},
             {x, 0.0},
             {2.0 * x, 0.0},
             {0.0, y},
             {2.0 * x, y},
             {0.0, 2.0 * y},
             {x, 2.0 * y},
             {2.0 * x, 2.0 * y}}};
}

namespace {

// A direction for each ray, of any length.
template <typename Way>
TileCone cone_about(std::span<const FloorRay> rays, const Way& way_of) {
    TileCone cone{.middle = way_of(rays.front()).normalized()};
    double widest2 = 0.0;  // squares of chords
    for (const FloorRay& ray : rays) {
        cone.sees_all &= ray.sees_floor();
        cone.sees_any |= ray.sees_floor();
        const Vector3d way = way_of(ray).normalized();
        widest2 = std::max(widest2, (way - cone.middle).squaredNorm());
    }
    cone.radius_rad = kTileRoom * 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(widest2)));
    return cone;
}

}  // namespace

TileCone tile_cone(const Vector3d& lamp_m, std::span<const FloorRay> rays) {
    return cone_about(rays, [&](const FloorRay& ray) { return towards(lamp_m, ray); });
}

TileCone plane_cone(const Vector3d& lamp_m, std::span<const FloorRay> rays) {
    return cone_about(rays, [&](const FloorRay& ray) -> Vector3d {
        return (ray.origin_m - lamp_m).cross(ray.direction);
    });
}

bool comes_into(const TileCone& cone, const Crease& crease) {
    const double r = cone.radius_rad;
    if (crease.is_quadratic) {
        const Vector3d turned = crease.Q * cone.middle;
        return std::abs(cone.middle.dot(turned) - crease.at) <=
               2.0 * r * turned.norm() + r * r * crease.Q.norm();
    }
    const double cosine = crease.l.dot(cone.middle);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return std::abs(cosine - crease.at) <= r * sine + 0.5 * r * r;
}

}  // namespace aphotic
