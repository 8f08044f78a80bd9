// SPDX-License-Identifier: BSD-3-Clause
#include "light/dispersion.h"

#include "rig/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace aphotic {
namespace {

// The wavelength at which water has this index; the index falls with the wavelength.
double wavelength_of_index(const Rig& rig, double index) {
    WavelengthRange between = rig.camera.range;
    constexpr int kHalvings = 60;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle_nm = std::midpoint(between.first_nm, between.last_nm);
        (rig.water.refractive_index(middle_nm) > index ? between.first_nm : between.last_nm) =
            middle_nm;
    }
    return between.first_nm;
}

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

std::vector<double> index_nodes_nm(const Rig& rig, std::size_t nodes) {
    if (!disperses(rig)) return {rig.camera.range.first_nm};
    const double first = rig.water.refractive_index(rig.camera.range.first_nm);
    const double last = rig.water.refractive_index(rig.camera.range.last_nm);
    std::vector<double> nodes_nm;
    for (std::size_t j = 0; j < nodes; ++j) {
        const double share = static_cast<double>(j) / static_cast<double>(nodes - 1);
        nodes_nm.push_back(wavelength_of_index(rig, std::lerp(first, last, share)));
    }
    return nodes_nm;
}

double index_share(const Rig& rig,
                   const std::vector<double>& nodes_nm,
                   std::size_t node,
                   double lambda_nm) {
    double value = 1.0;
    for (std::size_t m = 0; m < nodes_nm.size(); ++m) {
        if (m == node) continue;
        const double n_m = rig.water.refractive_index(nodes_nm[m]);
        value *= (rig.water.refractive_index(lambda_nm) - n_m) /
                 (rig.water.refractive_index(nodes_nm[node]) - n_m);
    }
    return value;
}

double corner_shift_px(const Rig& rig, double lambda_a_nm, double lambda_b_nm) {
    if (!disperses(rig)) return 0.0;
    double most_px = 0.0;
    for (const std::array<double, 2>& corner : corners_to_ask(rig.camera)) {
        const Eigen::Vector3d from_m = corner_point_m(rig, corner, 0.0, lambda_b_nm);
        const double pixel_m = (from_m - corner_point_m(rig, corner, 1.0, lambda_b_nm)).norm();
        const double shift_m = (corner_point_m(rig, corner, 0.0, lambda_a_nm) - from_m).norm();
        if (pixel_m > 0.0) most_px = std::max(most_px, shift_m / pixel_m);
    }
    return most_px;
}

}  // namespace aphotic
