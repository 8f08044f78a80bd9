// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_beam.h"

#include "base/error.h"

#include <Eigen/Geometry>

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

// At 90 degrees there is no edge.
Cone softened(Cone cone, double edge_rad) {
    constexpr double kNone_rad = 1.5;
    if (cone.edge_rad >= edge_rad || cone.half_angle_rad > kNone_rad) return cone;
    cone.half_angle_rad =
        std::min(0.5 * pi, cone.half_angle_rad + 0.5 * (edge_rad - cone.edge_rad));
    cone.edge_rad = std::min(edge_rad, cone.half_angle_rad);
    return cone;
}

// By central differences.
template <typename F>
Vector3d gradient_along_sphere(const Vector3d& w, const F& f) {
    const Vector3d one_way = w.unitOrthogonal();
    Vector3d gradient = Vector3d::Zero();
    for (const Vector3d& way : {one_way, Vector3d(w.cross(one_way))})
        gradient += (f(w + kSteps * way) - f(w - kSteps * way)) / (2.0 * kSteps) * way;
    return gradient;
}

}  // namespace

FitBeam FitBeam::table(std::size_t parts, double widest_rad) {
    FitBeam beam;
    beam.parts_ = parts;
    beam.widest_rad_ = widest_rad;
    return beam;
}

FitBeam FitBeam::cones(const Beam& beam, double block_rad) {
    if (beam.cones.empty())
        throw InputError("beam '{}': found one that is no sum of cones; allowed: cones", beam.name);
    FitBeam fit;
    fit.kind_ = FitBeamKind::Cones;
    fit.parts_ = beam.cones.size();
    fit.widest_rad_ = 0.5 * pi;
    fit.beam_ = beam;
    fit.beam_.weights = ConeWeights::Flux;
    for (Cone& cone : fit.beam_.cones) {
        cone.weight = 1.0;
        Beam part = fit.beam_;
        part.cones = {cone};
        const double axial = intensity_towards(part, kLampFrame, Vector3d::UnitZ());
        part.weights = ConeWeights::Literal;
        part.cones = {softened(cone, kSoftEdge * block_rad)};
        part.cones.front().weight = axial;
        fit.part_beams_.push_back(part);
    }
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
    fit.part_beams_ = {beam};
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
    if (kind_ == FitBeamKind::Optics) return {"focal_length_mm", "distance_mm"};
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

BeamOptics FitBeam::optics_with(const Shapes& shapes) const {
    BeamOptics optics = std::get<BeamOptics>(beam_.pattern);
    optics.focal_length_m = shapes[0];
    optics.distance_m = shapes[1];
    return optics;
}

void FitBeam::optics_at(const Vector3d& w,
                        bool has_slopes,
                        std::vector<BeamPartValue>& values) const {
    const Shapes shapes{shapes_[0], shapes_[1]};
    const BeamOptics optics = optics_with(shapes);
    const auto of = [&](const BeamOptics& lens, const std::optional<PatternView>& view) {
        // By the rig's flux: one of each lens would take long, and the share makes up for it.
        return view ? beam_.per_flux * view->factor * optics_intensity(lens, view->direction) : 0.0;
    };
    const auto view = pattern_view(beam_, kLampFrame, w);
    BeamPartValue value{.value = of(optics, view)};
    if (has_slopes) {
        value.gradient = gradient_along_sphere(
            w, [&](const Vector3d& v) { return of(optics, pattern_view(beam_, kLampFrame, v)); });
        for (std::size_t k = 0; k < shapes.size(); ++k) {
            Shapes more = shapes;
            Shapes less = shapes;
            const double step = kSteps * shapes[k];
            more[k] += step;
            less[k] -= step;
            value.by_shape[k] =
                (of(optics_with(more), view) - of(optics_with(less), view)) / (2.0 * step);
        }
    }
    values.push_back(value);
}

void FitBeam::at(const Vector3d& w, bool has_slopes, std::vector<BeamPartValue>& values) const {
    values.clear();
    if (kind_ == FitBeamKind::Table) return splines_at(w, values);
    if (kind_ == FitBeamKind::Cosine) return cosine_at(w, values);
    if (kind_ == FitBeamKind::Optics) return optics_at(w, has_slopes, values);
    for (std::size_t part = 0; part < parts_; ++part) {
        const auto of = [&](const Vector3d& v) {
            return intensity_towards(part_beams_[part], kLampFrame, v);
        };
        BeamPartValue value{.part = part, .value = of(w)};
        if (has_slopes) value.gradient = gradient_along_sphere(w, of);
        values.push_back(value);
    }
}

Eigen::VectorXd FitBeam::parts_at(double theta_rad) const {
    std::vector<BeamPartValue> values;
    at({std::sin(theta_rad), 0.0, std::cos(theta_rad)}, false, values);
    Eigen::VectorXd parts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parts_));
    for (const BeamPartValue& value : values)
        parts(static_cast<Eigen::Index>(value.part)) = value.value;
    return parts;
}

std::array<double, 2> FitBeam::slopes_at(double theta_rad) const {
    std::vector<BeamPartValue> values;
    at({std::sin(theta_rad), 0.0, std::cos(theta_rad)}, true, values);
    return values.empty() ? std::array<double, 2>{} : values.front().by_shape;
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
    if (kind_ == FitBeamKind::Held) return {.beam = beam_, .flux = flux};
    if (kind_ == FitBeamKind::Optics) {
        Beam beam = beam_;
        beam.pattern = optics_with({shapes_[0], shapes_[1]});
        beam = scaled_to_flux(std::move(beam));
        return {.beam = beam, .flux = flux * beam_.per_flux / beam.per_flux};
    }
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
