// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam.h"

#include "rig/geometry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr double kRightAngle_rad = 0.5 * std::numbers::pi;

// Of the lobe that is cos(theta) as far as the cone's edge.
double lobe_flux(const Cone& cone) {
    const double sin_gamma = std::sin(cone.half_angle_rad);
    return std::numbers::pi * sin_gamma * sin_gamma;
}

// A_k.
double axial_intensity(const Cone& cone, ConeWeights weights) {
    return weights == ConeWeights::Literal ? cone.weight : cone.weight / lobe_flux(cone);
}

}  // namespace

BeamFrame frame_about(const Vector3d& axis) {
    const bool is_fore_and_aft = axis.cross(Vector3d::UnitX()).norm() < kForeAndAftSine;
    const Vector3d reference = is_fore_and_aft ? Vector3d::UnitZ() : Vector3d::UnitX();
    const Vector3d along = (reference - reference.dot(axis) * axis).normalized();
    return {.axis = axis, .along = along, .across = axis.cross(along)};
}

double intensity_towards(const Beam& beam, const BeamFrame& frame, const Vector3d& towards) {
    return continued_intensity(beam, frame, towards, towards);
}

double continued_intensity(const Beam& beam,
                           const BeamFrame& frame,
                           const Vector3d& towards,
                           const Vector3d& from) {
    const double cos_theta = frame.axis.dot(towards) / towards.norm();
    if (cos_theta <= 0.0) return 0.0;
    const double cos_from = frame.axis.dot(from.normalized());
    double intensity = 0.0;
    for (const Cone& cone : beam.cones) {
        if (cos_from < std::cos(cone.half_angle_rad)) continue;
        intensity += axial_intensity(cone, beam.weights) * cos_theta;
    }
    return intensity;
}

double most_intensity(const Beam& beam,
                      const BeamFrame& frame,
                      const Vector3d& towards,
                      double within_rad) {
    const double theta_rad = angle_between(frame.axis, towards);
    const double cos_nearest = std::cos(std::max(0.0, theta_rad - within_rad));
    double intensity = 0.0;
    for (const Cone& cone : beam.cones) {
        if (theta_rad > cone.half_angle_rad + within_rad) continue;
        intensity += axial_intensity(cone, beam.weights) * cos_nearest;
    }
    return std::max(0.0, intensity);
}

double most_intensity(const Beam& beam) {
    double intensity = 0.0;
    for (const Lobe& lobe : lobes_of(beam)) intensity += lobe.on_axis;
    return intensity;
}

bool reaches(const Beam& beam, const BeamFrame& frame, const Vector3d& towards, double within_rad) {
    const double theta_rad = angle_between(frame.axis, towards);
    return std::ranges::any_of(beam.cones, [&](const Cone& cone) {
        return cone.weight > 0.0 && theta_rad <= cone.half_angle_rad + within_rad;
    });
}

bool is_dark(const Beam& beam) {
    return std::ranges::all_of(beam.cones, [](const Cone& cone) { return cone.weight == 0.0; });
}

std::vector<double> edges_rad(const Beam& beam) {
    std::vector<double> edges;
    for (const Cone& cone : beam.cones) {
        if (cone.weight == 0.0 || cone.half_angle_rad >= kRightAngle_rad) continue;
        edges.push_back(cone.half_angle_rad);
    }
    return edges;
}

Beam without_edges(Beam beam) {
    for (Cone& cone : beam.cones) {
        cone.weight = axial_intensity(cone, beam.weights);
        cone.half_angle_rad = kRightAngle_rad;
    }
    beam.weights = ConeWeights::Literal;
    return beam;
}

double flux_of(const Beam& beam) {
    double flux = 0.0;
    for (const Cone& cone : beam.cones) {
        flux += beam.weights == ConeWeights::Flux ? cone.weight : cone.weight * lobe_flux(cone);
    }
    return flux;
}

std::vector<Beam> parts_of(const Beam& beam) {
    std::vector<Beam> parts;
    for (const Cone& cone : beam.cones) {
        parts.push_back({.name = cone.part, .weights = beam.weights, .cones = {cone}});
    }
    return parts;
}

Beam parts_that(const Beam& beam, const std::function<bool(const Beam&)>& is_wanted) {
    Beam kept{.name = beam.name, .weights = beam.weights, .cones = {}};
    for (const Beam& part : parts_of(beam)) {
        if (is_wanted(part)) kept.cones.push_back(part.cones.front());
    }
    return kept;
}

std::vector<Lobe> lobes_of(const Beam& beam) {
    std::vector<Lobe> lobes;
    lobes.reserve(beam.cones.size());
    for (const Cone& cone : beam.cones) {
        lobes.push_back({.edge_cosine = std::cos(cone.half_angle_rad),
                         .on_axis = axial_intensity(cone, beam.weights)});
    }
    return lobes;
}

std::string beam_signature(const Beam& beam) {
    std::vector<std::string> cones;
    for (const Cone& cone : beam.cones) {
        // Names every field: a further one has to be told here.
        const auto& [part, half_angle_rad, weight] = cone;
        cones.push_back(
            fmt::format("{} rad {} 1/sr", half_angle_rad, axial_intensity(cone, beam.weights)));
    }
    return fmt::format("{}", fmt::join(cones, ", "));
}

}  // namespace aphotic
