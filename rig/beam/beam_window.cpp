// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_window.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// One face for one polarisation: p and q are n cos on either side for s, and cos/n for p.
struct Face {
    double by_cosine;  // transmittance / (cos on the side of the incident light)
    double reflected;
};

Face face(double index, double cosine, double index_beyond, double cos_beyond, bool is_s) {
    const double near_share = is_s ? index * cosine : index_beyond * cosine;
    const double far_share = is_s ? index_beyond * cos_beyond : index * cos_beyond;
    const double sum = near_share + far_share;
    const double reflected = (near_share - far_share) / sum;
    return {.by_cosine = 4.0 * index * index_beyond * cos_beyond / (sum * sum),
            .reflected = reflected * reflected};
}

double cosine_beyond(double sine, double index) {
    return std::sqrt(1.0 - sine * sine / (index * index));
}

}  // namespace

double transmittance_by_cosine(const BeamWindow& window, double cos_in_air) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cos_in_air * cos_in_air));
    const double cos_glass = cosine_beyond(sine, window.glass_index);
    const double cos_water = cosine_beyond(sine, window.water_index);
    double sum = 0.0;
    for (const bool is_s : {true, false}) {
        if (window.glass_index ==
            1.0) {  // no glass at all: at grazing incidence nothing of its cosine is left
            sum += face(1.0, cos_in_air, window.water_index, cos_water, is_s).by_cosine;
            continue;
        }
        const Face outer = face(1.0, cos_in_air, window.glass_index, cos_glass, is_s);
        const Face inner = face(window.glass_index, cos_glass, window.water_index, cos_water, is_s);
        sum += outer.by_cosine * inner.by_cosine * cos_glass /
               (1.0 - outer.reflected * inner.reflected);
    }
    return 0.5 * sum;
}

double window_factor(const BeamWindow& window, double cos_in_air) {
    const double n = window.water_index;
    const double sine2 = std::max(0.0, 1.0 - cos_in_air * cos_in_air);
    return transmittance_by_cosine(window, cos_in_air) * n * std::sqrt(n * n - sine2);
}

std::optional<LightInAir> in_air(const BeamWindow& window, const Vector3d& in_water) {
    const Vector3d unit = in_water.normalized();
    const double x = window.water_index * unit.x();
    const double y = window.water_index * unit.y();
    const double cos2 = 1.0 - x * x - y * y;
    if (!(unit.z() > 0.0) || cos2 < 0.0) return std::nullopt;
    const double cosine = std::sqrt(cos2);
    return LightInAir{.direction = {x, y, cosine}, .factor = window_factor(window, cosine)};
}

double widest_in_water_rad(const BeamWindow& window) {
    return std::asin(1.0 / window.water_index);
}

double angle_in_air_rad(const BeamWindow& window, double in_water_rad) {
    return std::asin(std::min(1.0, window.water_index * std::sin(std::max(0.0, in_water_rad))));
}

double angle_in_water_rad(const BeamWindow& window, double in_air_rad) {
    return std::asin(std::sin(std::clamp(in_air_rad, 0.0, 0.5 * std::numbers::pi)) /
                     window.water_index);
}

}  // namespace aphotic
