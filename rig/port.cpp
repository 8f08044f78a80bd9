// SPDX-License-Identifier: BSD-3-Clause
#include "rig/port.h"

#include <fmt/format.h>

#include <cmath>

namespace aphotic {

using Eigen::Vector2d;
using Eigen::Vector3d;

WaterRay ray_into_water(const Port& port,
                        const Vector3d& in_air,
                        double lambda_nm,
                        double water_index) {
    if (!port) return {.origin_m = Vector3d::Zero(), .direction = in_air};
    const Vector2d sin_air = in_air.head<2>();
    const Vector2d sin_glass = sin_air / port->glass.index(lambda_nm);
    const Vector2d sin_water = sin_air / water_index;
    const double cos_glass = std::sqrt(1.0 - sin_glass.squaredNorm());
    const double cos_water = std::sqrt(1.0 - sin_water.squaredNorm());

    WaterRay ray;
    ray.origin_m.head<2>() =
        port->distance_m * sin_air / in_air.z() + port->thickness_m * sin_glass / cos_glass;
    ray.origin_m.z() = front_m(port);
    ray.direction << sin_water, cos_water;
    return ray;
}

double front_m(const Port& port) {
    return port ? port->distance_m + port->thickness_m : 0.0;
}

int steps_along_rim(const Port& port) {
    constexpr int kWhereRaysBend = 512;
    return port ? kWhereRaysBend : 1;
}

std::string port_signature(const FlatPort& port) {
    // Names every field: a further one has to be told here.
    const auto& [distance_m, thickness_m, glass] = port;
    return fmt::format("{} m off, {} m of {}", distance_m, thickness_m, glass.name());
}

}  // namespace aphotic
