// SPDX-License-Identifier: BSD-3-Clause
#include "light/beam_width.h"

#include "light/steep_crease.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <variant>
#include <vector>

namespace aphotic {
namespace {

double least_step(const std::vector<double>& angles_rad) {
    double least = std::numbers::pi;
    for (std::size_t i = 1; i < angles_rad.size(); ++i)
        least = std::min(least, angles_rad[i] - angles_rad[i - 1]);
    return least;
}

// A soft edge is even in the cosine.
double half_lit_rad(const Cone& cone) {
    if (cone.edge_rad == 0.0) return cone.half_angle_rad;
    return std::acos(std::midpoint(std::cos(cone.half_angle_rad - cone.edge_rad),
                                   std::cos(cone.half_angle_rad)));
}

}  // namespace

double narrowest_rad(const Beam& beam) {
    double narrowest = std::numbers::pi;
    for (const Cone& cone : beam.cones) {
        narrowest = std::min({narrowest, 2.0 * half_lit_rad(cone), 2.0 / std::sqrt(cone.exponent)});
    }
    const bool is_steep = !steep_creases(beam, frame_about(Eigen::Vector3d::UnitZ())).empty();
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern); table != nullptr && is_steep) {
        narrowest = std::min({narrowest,
                              2.0 * least_step(table->vertical_rad),
                              2.0 * least_step(table->horizontal_rad)});
    }
    if (const auto* optics = std::get_if<BeamOptics>(&beam.pattern)) {
        narrowest = std::min(narrowest,
                             2.0 * std::atan(0.5 * std::min(optics->along_m, optics->across_m) /
                                             optics->distance_m));
    }
    return narrowest;
}

}  // namespace aphotic
