// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/frame_groups.h"

#include "rig/geometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aphotic {

namespace {

// The intersection with the plane of the ray of a point `inward_px` from the corner, towards the
// middle.
Eigen::Vector3d corner_point_m(const Rig& rig,
                               const std::array<double, 2>& corner,
                               double inward_px,
                               double lambda_nm) {
    const Camera& camera = rig.camera;
    const double share = inward_px / std::hypot(0.5 * camera.width_px, 0.5 * camera.height_px);
    const WaterRay ray = pixel_ray(rig,
                                   corner[0] + share * (0.5 * camera.width_px - corner[0]),
                                   corner[1] + share * (0.5 * camera.height_px - corner[1]),
                                   lambda_nm);
    const Plane plane{.point_m = {0.0, 0.0, rig.sled.altitude_m}, .normal = {0.0, 0.0, -1.0}};
    return ray.origin_m + distance_to(plane, ray).value_or(0.0) * ray.direction;
}

}  // namespace

double corner_shift_px(const Rig& rig, double lambda_a_nm, double lambda_b_nm) {
    if (!rig.camera.port) return 0.0;
    double most_px = 0.0;
    for (const std::array<double, 2>& corner : corners_to_ask(rig.camera)) {
        const Eigen::Vector3d from_m = corner_point_m(rig, corner, 0.0, lambda_b_nm);
        const double pixel_m = (from_m - corner_point_m(rig, corner, 1.0, lambda_b_nm)).norm();
        const double shift_m = (corner_point_m(rig, corner, 0.0, lambda_a_nm) - from_m).norm();
        if (pixel_m > 0.0) most_px = std::max(most_px, shift_m / pixel_m);
    }
    return most_px;
}

std::vector<FrameGroup> frame_groups(const Rig& rig,
                                     std::span<const double> lambda_nm,
                                     int per_frame,
                                     double pixel_shift) {
    std::vector<FrameGroup> groups;
    for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
        const bool joins =
            !groups.empty() && groups.back().count < static_cast<std::size_t>(per_frame) &&
            corner_shift_px(rig, lambda_nm[groups.back().first], lambda_nm[i]) <= pixel_shift;
        if (!joins) groups.push_back({.first = i, .count = 0, .index_nm = 0.0});
        FrameGroup& group = groups.back();
        ++group.count;
        group.index_nm = std::midpoint(lambda_nm[group.first], lambda_nm[i]);
    }
    return groups;
}

}  // namespace aphotic
