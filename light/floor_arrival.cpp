// SPDX-License-Identifier: BSD-3-Clause
#include "light/floor_arrival.h"

#include <numbers>

namespace aphotic {

using Eigen::Vector3d;

std::optional<FloorArrival> arrival_of(const Rig& rig,
                                       const Strobe& strobe,
                                       const WaterRay& ray,
                                       const Vector3d& lit_m) {
    const Plane floor = floor_plane(rig.sled);
    const FloorRay sight = floor_ray(ray, floor);
    if (!sight.sees_floor()) return std::nullopt;
    const double height_m = height_above(floor, strobe.position_m);
    FloorArrival light;
    if (height_m <= 0.0) return light;
    light.towards = towards(strobe.position_m, sight);
    const double I = continued_intensity(
        strobe.beam, frame_about(strobe.axis), light.towards, lit_m - strobe.position_m);
    if (I == 0.0) return light;
    const double share = strobe.power / std::numbers::pi;
    const double length = light.towards.norm();
    const Arriving<double> even = arriving(height_m, sight.height_m, sight.down, length);
    light.diffuse = share * I * even.per_area;
    light.path_m = even.path_m;
    if (rig.seafloor.phong == 0.0) return light;
    light.highlight =
        share * I *
        highlight_per_area(
            rig.seafloor, height_m, sight.down, sight.direction.dot(light.towards), length);
    return light;
}

}  // namespace aphotic
