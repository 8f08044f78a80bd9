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
    if (height_m <= 0.0) return FloorArrival{};
    const BeamFrame frame = frame_about(strobe.axis);
    return arrival(rig.seafloor,
                   strobe.position_m,
                   height_m,
                   strobe.power / std::numbers::pi,
                   sight,
                   [&](const Vector3d& towards) {
                       return continued_intensity(
                           strobe.beam, frame, towards, lit_m - strobe.position_m);
                   });
}

}  // namespace aphotic
