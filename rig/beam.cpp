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

// cos^n, of a cosine that is not negative.
double falloff(double cosine, double exponent) {
    return exponent == 1.0 ? cosine : std::pow(cosine, exponent);
}

// Of the lobe that is cos^n(theta) as far as the cone's edge. 1 - cos^(n + 1) is a small difference
// for narrow cones: expm1 and log1p keep its digits.
double lobe_flux(const Cone& cone) {
    const double sin_gamma = std::sin(cone.half_angle_rad);
    if (cone.exponent == 1.0) return std::numbers::pi * sin_gamma * sin_gamma;
    const double sin_half = std::sin(0.5 * cone.half_angle_rad);
    const double ln_cos = std::log1p(-2.0 * sin_half * sin_half);
    const double n = cone.exponent + 1.0;
    return -2.0 * std::numbers::pi / n * std::expm1(n * ln_cos);
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
        intensity += axial_intensity(cone, beam.weights) * falloff(cos_theta, cone.exponent);
    }
    return intensity;
}

double most_intensity(const Beam& beam,
                      const BeamFrame& frame,
                      const Vector3d& towards,
                      double within_rad) {
    const double theta_rad = angle_between(frame.axis, towards);
    const double cos_nearest = std::max(0.0, std::cos(std::max(0.0, theta_rad - within_rad)));
    double intensity = 0.0;
    for (const Cone& cone : beam.cones) {
        if (theta_rad > cone.half_angle_rad + within_rad) continue;
        intensity += axial_intensity(cone, beam.weights) * falloff(cos_nearest, cone.exponent);
    }
    return intensity;
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
        const bool ends_smoothly = cone.half_angle_rad >= kRightAngle_rad && cone.exponent >= 1.0;
        if (cone.weight > 0.0 && !ends_smoothly) edges.push_back(cone.half_angle_rad);
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

double steepest_exponent(const Beam& beam) {
    double steepest = 0.0;
    for (const Cone& cone : beam.cones) steepest = std::max(steepest, cone.exponent);
    return steepest;
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
                         .on_axis = axial_intensity(cone, beam.weights),
                         .exponent = cone.exponent});
    }
    return lobes;
}

std::string beam_signature(const Beam& beam) {
    std::vector<std::string> cones;
    for (const Cone& cone : beam.cones) {
        // Names every field: a further one has to be told here.
        const auto& [part, half_angle_rad, weight, exponent] = cone;
        cones.push_back(
            fmt::format("{} rad {} 1/sr", half_angle_rad, axial_intensity(cone, beam.weights)));
        if (exponent != 1.0) cones.back() += fmt::format(" cos^{}", exponent);
    }
    return fmt::format("{}", fmt::join(cones, ", "));
}

}  // namespace aphotic
