// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/floor_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {

using Eigen::Vector3d;

std::optional<FloorLight> floor_light(const Rig& rig,
                                      const Strobe& strobe,
                                      const WaterRay& ray,
                                      const Vector3d& lobes_at_m) {
    const Plane floor = floor_plane(rig.sled);
    const auto distance_m = distance_to(floor, ray);
    if (!distance_m) return std::nullopt;
    const Vector3d towards = ray.origin_m + *distance_m * ray.direction - strobe.position_m;
    const double d_m = towards.norm();
    const double cos_i = -floor.normal.dot(towards) / d_m;
    FloorLight light{.path_m = d_m + *distance_m};
    if (cos_i <= 0.0) return light;
    const double intensity = continued_intensity(
        strobe.beam, frame_about(strobe.axis), towards, lobes_at_m - strobe.position_m);
    const double facing = strobe.power * intensity / (std::numbers::pi * d_m * d_m);
    light.diffuse_per_m2 = facing * cos_i;
    if (rig.seafloor.phong > 0.0) {
        const Vector3d mirrored =
            ray.direction - 2.0 * ray.direction.dot(floor.normal) * floor.normal;
        const double cos_mirrored = std::max(0.0, -mirrored.dot(towards) / d_m);
        light.specular_per_m2 =
            facing * rig.seafloor.phong * std::pow(cos_mirrored, rig.seafloor.phong_size);
    }
    return light;
}

}  // namespace aphotic
