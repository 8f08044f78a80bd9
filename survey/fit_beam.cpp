// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit_beam.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace aphotic {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kOnAxis = 1e-12;
constexpr double kSteps = 1e-5;  // of central differences: relative, and of directions

const BeamFrame kLampFrame{
    .axis = Vector3d::UnitZ(), .along = Vector3d::UnitX(), .across = Vector3d::UnitY()};

// The four splines over a step, u from 0 to 1, and their slopes by u.
struct Splines {
    std::array<double, 4> value;
    std::array<double, 4> slope;
};

Splines splines_over_step(double u) {
    const double v = 1.0 - u;
    return {.value = {v * v * v / 6.0,
                      (4.0 + u * u * (3.0 * u - 6.0)) / 6.0,
                      (4.0 + v * v * (3.0 * v - 6.0)) / 6.0,
                      u * u * u / 6.0},
            .slope = {-0.5 * v * v, u * (1.5 * u - 2.0), -v * (1.5 * v - 2.0), 0.5 * u * u}};
}

BeamTable table_of(std::vector<double> theta_rad, std::vector<double> intensity) {
    return {.angles = TableAngles::TypeC,
            .vertical_rad = std::move(theta_rad),
            .horizontal_rad = {0.0},
            .intensity = std::move(intensity)};
}

}  // namespace

FitBeam FitBeam::table(std::size_t parts, double widest_rad) {
    FitBeam beam;
    beam.parts_ = parts;
    beam.widest_rad_ = widest_rad;
    return beam;
}

FitBeam FitBeam::cones(const Beam& beam) {
    if (beam.cones.empty())
        throw InputError("beam '{}': found one that is no sum of cones; allowed: cones", beam.name);
    FitBeam fit;
    fit.kind_ = FitBeamKind::Cones;
    fit.parts_ = beam.cones.size();
    fit.widest_rad_ = 0.5 * pi;
    fit.beam_ = beam;
    fit.beam_.weights = ConeWeights::Flux;
    for (Cone& cone : fit.beam_.cones) cone.weight = 1.0;
    return fit;
}

FitBeam FitBeam::cosine(double exponent) {
    FitBeam fit;
    fit.kind_ = FitBeamKind::Cosine;
    fit.parts_ = 1;
    fit.widest_rad_ = 0.5 * pi;
    fit.shapes_ = {exponent};
    return fit;
}

FitBeam FitBeam::held(const Beam& beam) {
    FitBeam fit;
    fit.kind_ = FitBeamKind::Held;
    fit.parts_ = 1;
    fit.widest_rad_ = 0.5 * pi;
    fit.beam_ = beam;
    return fit;
}

FitBeam FitBeam::optics(const Beam& beam) {
    const auto* optics = std::get_if<BeamOptics>(&beam.pattern);
    if (optics == nullptr)
        throw InputError("beam '{}': found one that is of no optics; allowed: optics", beam.name);
    FitBeam fit;
    fit.kind_ = FitBeamKind::Optics;
    fit.parts_ = 1;
    fit.widest_rad_ = 0.5 * pi;
    fit.beam_ = beam;
    fit.shapes_ = {optics->focal_length_m, optics->distance_m};
    return fit;
}

std::vector<std::string> FitBeam::shape_names() const {
    if (kind_ == FitBeamKind::Cosine) return {"exponent"};
    if (kind_ == FitBeamKind::Optics) return {"focal_length_m", "distance_m"};
    return {};
}

void FitBeam::splines_at(const Vector3d& w, std::vector<BeamPartValue>& values) const {
    const double sine = std::sqrt(w.x() * w.x() + w.y() * w.y());
    const double theta_rad = std::atan2(sine, w.z());
    if (theta_rad > widest_rad_) return;
    const double step_rad = widest_rad_ / static_cast<double>(parts_ - 2);
    const double place = theta_rad / step_rad;
    const std::size_t first = std::min(static_cast<std::size_t>(place), parts_ - 3);
    const Splines splines = splines_over_step(place - static_cast<double>(first));
    // Of the angle over the direction, along the sphere; on the axis nothing even has a slope.
    const double per_sine = sine < kOnAxis ? 0.0 : 1.0 / (sine * step_rad);
    const Vector3d away(w.x() * w.z() * per_sine, w.y() * w.z() * per_sine, -sine / step_rad);
    for (std::size_t i = 0; i < 4; ++i) {
        if (first == 0 && i == 0) continue;
        values.push_back({.part = first + i - 1,
                          .value = splines.value[i],
                          .gradient = splines.slope[i] * away});
    }
    if (first > 0) return;
    // Knot -1 is knot 1, mirrored.
    values[1].value += splines.value[0];
    values[1].gradient += splines.slope[0] * away;
}

void FitBeam::cosine_at(const Vector3d& w, std::vector<BeamPartValue>& values) const {
    if (w.z() <= 0.0) return;
    const double n = shapes_.front();
    const double value = (n + 1.0) / (2.0 * pi) * std::pow(w.z(), n);
    // Along the sphere, as all gradients here.
    const Vector3d gradient = n * value / w.z() * (Vector3d::UnitZ() - w.z() * w);
    values.push_back({.part = 0,
                      .value = value,
                      .gradient = gradient,
                      .by_shape = {value * (1.0 / (n + 1.0) + std::log(w.z())), 0.0}});
}

Beam FitBeam::part_with(std::size_t part, const std::vector<double>& shapes) const {
    Beam beam = beam_;
    if (kind_ == FitBeamKind::Held) return beam;
    if (kind_ == FitBeamKind::Cones) {
        beam.cones = {beam_.cones[part]};
        return beam;
    }
    auto& optics = std::get<BeamOptics>(beam.pattern);
    optics.focal_length_m = shapes[0];
    optics.distance_m = shapes[1];
    return scaled_to_flux(std::move(beam));
}

void FitBeam::at(const Vector3d& w, std::vector<BeamPartValue>& values) const {
    values.clear();
    if (kind_ == FitBeamKind::Table) return splines_at(w, values);
    if (kind_ == FitBeamKind::Cosine) return cosine_at(w, values);
    for (std::size_t part = 0; part < parts_; ++part) {
        const Beam beam = part_with(part, shapes_);
        const auto of = [&](const Beam& b, const Vector3d& v) {
            return intensity_towards(b, kLampFrame, v);
        };
        BeamPartValue value{.part = part, .value = of(beam, w)};
        for (Eigen::Index i = 0; i < 3; ++i) {
            const Vector3d step = kSteps * Vector3d::Unit(i);
            value.gradient(i) = (of(beam, w + step) - of(beam, w - step)) / (2.0 * kSteps);
        }
        for (std::size_t k = 0; k < shapes_.size(); ++k) {
            std::vector<double> more = shapes_;
            std::vector<double> less = shapes_;
            const double step = kSteps * shapes_[k];
            more[k] += step;
            less[k] -= step;
            value.by_shape[k] =
                (of(part_with(part, more), w) - of(part_with(part, less), w)) / (2.0 * step);
        }
        values.push_back(value);
    }
}

Eigen::VectorXd FitBeam::parts_at(double theta_rad) const {
    std::vector<BeamPartValue> values;
    at({std::sin(theta_rad), 0.0, std::cos(theta_rad)}, values);
    Eigen::VectorXd parts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parts_));
    for (const BeamPartValue& value : values)
        parts(static_cast<Eigen::Index>(value.part)) = value.value;
    return parts;
}

FitBeam::Fitted FitBeam::beam_of(const Eigen::VectorXd& shares) const {
    if (kind_ == FitBeamKind::Table) {
        const double step_rad = kFittedStep_deg * pi / 180.0;
        std::vector<double> theta_rad;
        for (double theta = 0.0; theta < widest_rad_ - 0.1 * step_rad; theta += step_rad)
            theta_rad.push_back(theta);
        theta_rad.push_back(widest_rad_);
        std::vector<double> intensity;
        for (const double theta : theta_rad) intensity.push_back(parts_at(theta).dot(shares));
        Beam beam;
        beam.pattern = table_of(theta_rad, intensity);
        beam = scaled_to_flux(std::move(beam));
        return {.beam = beam, .flux = 1.0 / beam.per_flux};
    }
    const double flux = shares.sum();
    if (kind_ == FitBeamKind::Optics || kind_ == FitBeamKind::Held)
        return {.beam = part_with(0, shapes_), .flux = flux};
    if (kind_ == FitBeamKind::Cosine) {
        Beam beam;
        beam.cones = {{.part = "cosine",
                       .half_angle_rad = 0.5 * pi,
                       .weight = 1.0,
                       .exponent = shapes_.front()}};
        return {.beam = std::move(beam), .flux = flux};
    }
    Beam beam = beam_;
    for (std::size_t k = 0; k < parts_; ++k)
        beam.cones[k].weight = shares(static_cast<Eigen::Index>(k)) / flux;
    return {.beam = std::move(beam), .flux = flux};
}

}  // namespace aphotic
