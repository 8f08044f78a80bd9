// SPDX-License-Identifier: BSD-3-Clause
//
// Rays of kLanes places (base/lanes.h), each with a floor of its own, in floor_ray.h's symbols:
//
//   w = max(0, -n.D)     H = n.(o - p)     V = w (o - s) + H D
//
// n, p   the floor's normal, on the side of the camera, and a point of it
// w      0 also where the ray starts below its floor, so a ray with w > 0 sees it
#pragma once

#include "base/lanes.h"
#include "rig/geometry.h"

#include <Eigen/Core>

#include <cstddef>

namespace aphotic {

[[nodiscard]] inline Lanes every_lane(double value) {
    Lanes lanes;
    lanes.lane.fill(value);
    return lanes;
}
[[nodiscard]] inline LaneVector every_lane(const Eigen::Vector3d& v) {
    return {every_lane(v.x()), every_lane(v.y()), every_lane(v.z())};
}
[[nodiscard]] inline Eigen::Vector3d vector_of_lane(const LaneVector& v, std::size_t k) {
    return {v[0][k], v[1][k], v[2][k]};
}
inline void set_lane(LaneVector& v, std::size_t k, const Eigen::Vector3d& value) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i][k] = value(static_cast<Eigen::Index>(i));
}

struct LanePlane {
    LaneVector point_m;
    LaneVector normal;
};
[[nodiscard]] inline LanePlane every_lane(const Plane& plane) {
    return {.point_m = every_lane(plane.point_m), .normal = every_lane(plane.normal)};
}

[[nodiscard]] inline PackVector minus(const PackVector& v, const auto& w) {
    return {v[0] - w[0], v[1] - w[1], v[2] - w[2]};
}

// In water.
struct LaneRay {
    LaneVector origin_m;
    LaneVector direction;
    Lanes down;      // w
    Lanes height_m;  // H
};

// Sets w and H of a ray whose origin and direction are known.
inline void meet(const LanePlane& floor, LaneRay& ray) {
    for_each_pack([&](std::size_t k) {
        const PackVector n = pack(floor.normal, k);
        const Pack H = dot(n, minus(pack(ray.origin_m, k), pack(floor.point_m, k)));
        Pack w = std::experimental::max(-dot(n, pack(ray.direction, k)), Pack(0.0));
        where(H <= 0.0, w) = 0.0;
        ray.down.set_pack(k, w);
        ray.height_m.set_pack(k, H);
    });
}

// V of a lamp, of the pack that starts at a lane.
[[nodiscard]] inline PackVector towards(const Eigen::Vector3d& lamp_m,
                                        const LaneRay& ray,
                                        std::size_t k) {
    const Pack w = ray.down.pack(k);
    const Pack H = ray.height_m.pack(k);
    const PackVector D = pack(ray.direction, k);
    const PackVector from_m = minus(pack(ray.origin_m, k), lamp_m);
    return {w * from_m[0] + H * D[0], w * from_m[1] + H * D[1], w * from_m[2] + H * D[2]};
}

}  // namespace aphotic
