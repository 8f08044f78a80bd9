// SPDX-License-Identifier: BSD-3-Clause
#include "rig/lens.h"

#include <fmt/format.h>

#include <cmath>

namespace aphotic {

using Eigen::Vector3d;

Vector3d direction_in_air(const Camera& camera, double column, double row) {
    return Vector3d((0.5 * camera.height_px - row) * camera.pixel_pitch_m,
                    (column - 0.5 * camera.width_px) * camera.pixel_pitch_m,
                    camera.focal_length_m)
        .normalized();
}

double half_view_rad(const Camera& camera) {
    return std::atan(0.5 * std::hypot(camera.width_px, camera.height_px) * camera.pixel_pitch_m /
                     camera.focal_length_m);
}

bool is_in_view(const Camera& camera, const Vector3d& point_m, double factor) {
    const double reach = factor * 0.5 * camera.pixel_pitch_m / camera.focal_length_m;
    return point_m.z() > 0.0 && std::abs(point_m.x()) <= reach * camera.height_px * point_m.z() &&
           std::abs(point_m.y()) <= reach * camera.width_px * point_m.z();
}

std::map<std::string, std::string> lens_signature(const Camera& camera) {
    return {{"camera.resolution", fmt::format("{} {}", camera.width_px, camera.height_px)},
            {"camera.pixel_pitch_m", fmt::format("{}", camera.pixel_pitch_m)},
            {"camera.focal_length_m", fmt::format("{}", camera.focal_length_m)}};
}

}  // namespace aphotic
