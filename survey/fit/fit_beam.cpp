// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_beam.h"

#include "base/error.h"

#include <Eigen/Geometry>
#include <boost/math/special_functions/cardinal_b_spline.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kOnAxis = 1e-12;
constexpr double kSteps = 1e-5;  // of central differences, relative
// A table starts at this share of the brightest or more, since the logarithm of 0 is undefined.
constexpr double kDimmest = 0.02;
constexpr double kScaleHeld = 0.01;  // the relative error to which the scale of a beam is held

const BeamFrame kLampFrame{
    .axis = Vector3d::UnitZ(), .along = Vector3d::UnitX(), .across = Vector3d::UnitY()};

Vector3d direction_at(double theta_rad) {
    return {std::sin(theta_rad), 0.0, std::cos(theta_rad)};
}

// A knot's spline at a place, both in steps from the axis, where it is mirrored, and its slope over
// the step.
struct Spline {
    double value;
    double slope;
};
Spline spline_at(double place, std::size_t knot) {
    using boost::math::cardinal_b_spline;
    using boost::math::cardinal_b_spline_prime;
    const double off = place - static_cast<double>(knot);
    Spline spline{.value = cardinal_b_spline<3>(off), .slope = cardinal_b_spline_prime<3>(off)};
    if (knot == 1) {
        spline.value += cardinal_b_spline<3>(place + 1.0);
        spline.slope += cardinal_b_spline_prime<3>(place + 1.0);
    }
    return spline;
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

Beam alone(Beam beam, const Cone& cone) {
    beam.cones = {cone};
    return beam;
}

// Of flux 1, as an intensity on the axis: to take the flux of a soft cone again for every ray was a
// third of the time of a fit.
Beam softened(Beam beam, const Cone& cone, double edge_rad) {
    beam.weights = ConeWeights::Literal;
    beam.cones = {softened(cone, edge_rad)};
    double& weight = beam.cones.front().weight;
    weight = 1.0;
    weight = 1.0 / flux_of(beam);
    return beam;
}

Beam as_table(const std::vector<double>& theta_rad, const std::vector<double>& intensity) {
    Beam beam;
    beam.pattern = BeamTable{.angles = TableAngles::TypeC,
                             .vertical_rad = theta_rad,
                             .horizontal_rad = {0.0},
                             .intensity = intensity};
    return scaled_to_flux(std::move(beam));
}

Beam cosine_beam(double exponent) {
    Beam beam;
    beam.cones = {
        {.part = "cosine", .half_angle_rad = 0.5 * pi, .weight = 1.0, .exponent = exponent}};
    return beam;
}

}  // namespace

FitBeam::FitBeam(FitBeamKind kind, const Beam& beam, double widest_rad, double block_rad)
    : kind_(kind), widest_rad_(kind == FitBeamKind::Table ? widest_rad : 0.5 * pi), beam_(beam) {
    if (kind == FitBeamKind::Table) {
        begin_table();
    } else if (kind == FitBeamKind::Held) {
        if (beam.cones.empty()) parts_ = {beam};
        for (const Cone& cone : beam.cones) {
            parts_.push_back(softened(beam, cone, kSoftEdge * block_rad));
            parts_.back().cones.front().weight *= flux_of(alone(beam, cone));
        }
    } else if (kind == FitBeamKind::Cones) {
        if (beam.cones.empty())
            throw InputError("beam '{}': found one that is not a sum of cones; allowed: cones",
                             beam.name);
        for (const Cone& cone : beam.cones) {
            parts_.push_back(softened(beam, cone, kSoftEdge * block_rad));
            c_.push_back(std::max(flux_of(alone(beam, cone)), 1e-3));
        }
        const auto shares = Eigen::RowVectorXd::Map(c_.data(), std::ssize(c_));
        prior_ = {.rows = shares / (shares.sum() * kScaleHeld), .means = VectorXd::Zero(1)};
    } else if (kind == FitBeamKind::Cosine) {
        c_ = {std::max(1.0, beam.cones.empty() ? 1.0 : beam.cones.front().exponent)};
    } else if (kind == FitBeamKind::Optics) {
        const auto* optics = std::get_if<BeamOptics>(&beam.pattern);
        if (optics == nullptr)
            throw InputError("beam '{}': found one without optics; allowed: optics", beam.name);
        c_ = {optics->focal_length_m, optics->distance_m};
    }
}

// The rig's at the knots. Second differences on the axis are with the mirrored knot; the last row
// holds the mean over what is lit.
void FitBeam::begin_table() {
    const auto count = static_cast<Index>(std::max(4.0, std::ceil(widest_rad_ / kKnot_rad) + 2.0));
    widest_rad_ = static_cast<double>(count - 2) * kKnot_rad;
    const auto theta_rad = [](Index k) { return static_cast<double>(k) * kKnot_rad; };
    VectorXd lit(count);
    for (Index k = 0; k < count; ++k)
        lit(k) =
            intensity_towards(beam_, kLampFrame, direction_at(std::min(0.5 * pi, theta_rad(k))));
    lit = lit.cwiseMax(kDimmest * lit.maxCoeff());
    const VectorXd c = lit.array().log();
    c_.assign(c.begin(), c.end());
    MatrixXd& rows = prior_.rows;
    rows.setZero(count, count);
    for (Index k = 0; k + 1 < count; ++k) {
        rows(k, k) -= 2.0 / kRoughness;
        rows(k, k + 1) += 1.0 / kRoughness;
        rows(k, std::abs(k - 1)) += 1.0 / kRoughness;
    }
    for (Index k = 0; k < count; ++k) rows(count - 1, k) = lit(k) * std::sin(theta_rad(k));
    rows.row(count - 1) /= rows.row(count - 1).sum() * kScaleHeld;
    prior_.means = -rows * c;
    prior_.means(count - 1) = 0.0;
}

// A rig of another kind hardly constrains a cosine.
double FitBeam::spread() const {
    return kind_ == FitBeamKind::Cosine ? 3.0 * kShapeSpread : kShapeSpread;
}

std::vector<std::string> FitBeam::names() const {
    if (kind_ == FitBeamKind::Cosine) return {"exponent"};
    if (kind_ == FitBeamKind::Optics) return {"focal_length_mm", "distance_mm"};
    std::vector<std::string> names;
    if (kind_ == FitBeamKind::Cones)
        for (const Cone& cone : beam_.cones) names.push_back(cone.part);
    return names;
}

double FitBeam::table_intensity_at(double theta_rad) const {
    BeamValue value;
    table_at(direction_at(theta_rad), value);
    return value.intensity;
}

void FitBeam::table_at(const Vector3d& w, BeamValue& value) const {
    const double sine = std::hypot(w.x(), w.y());
    const double theta_rad = std::atan2(sine, w.z());
    const double place = std::min(theta_rad, widest_rad_) / kKnot_rad;
    value.first = std::clamp<std::size_t>(static_cast<std::size_t>(place), 1, c_.size() - 3) - 1;
    value.by.clear();
    double log_intensity = 0.0;
    double slope = 0.0;
    const double beyond = std::max(0.0, theta_rad - widest_rad_) / kKnot_rad;
    for (std::size_t k = value.first; k < value.first + 4; ++k) {
        const Spline spline = spline_at(place, k);
        value.by.push_back(spline.value + beyond * spline.slope);
        log_intensity += c_[k] * value.by.back();
        slope += c_[k] * spline.slope / kKnot_rad;
    }
    value.intensity = std::exp(log_intensity);
    for (double& by : value.by) by *= value.intensity;
    // The angle over the direction, along the sphere; on the axis an even function has slope 0.
    const double per_sine = sine < kOnAxis ? 0.0 : 1.0 / sine;
    value.gradient = value.intensity * slope *
                     Vector3d(w.x() * w.z() * per_sine, w.y() * w.z() * per_sine, -sine);
}

void FitBeam::cosine_at(const Vector3d& w, BeamValue& value) const {
    value.first = 0;
    value.by.assign(1, 0.0);
    value.intensity = 0.0;
    value.gradient.setZero();
    if (w.z() <= 0.0) return;
    const double n = c_.front();
    value.intensity = (n + 1.0) / (2.0 * pi) * std::pow(w.z(), n);
    value.gradient = n * value.intensity / w.z() * (Vector3d::UnitZ() - w.z() * w);
    value.by[0] = value.intensity * (1.0 / (n + 1.0) + std::log(w.z()));
}

BeamOptics FitBeam::optics_with(const std::vector<double>& c) const {
    BeamOptics optics = std::get<BeamOptics>(beam_.pattern);
    optics.focal_length_m = c[0];
    optics.distance_m = c[1];
    return optics;
}

// Optics with the rig's own flux: one for each lens would take long, and the powers compensate.
double FitBeam::intensity_with(const std::vector<double>& c, const Vector3d& w) const {
    if (kind_ == FitBeamKind::Optics) {
        const auto view = pattern_view(beam_, kLampFrame, w);
        return view ? beam_.per_flux * view->factor *
                          optics_intensity(optics_with(c), view->direction)
                    : 0.0;
    }
    double sum = 0.0;
    for (std::size_t k = 0; k < parts_.size(); ++k)
        sum += (c.empty() ? 1.0 : c[k]) * intensity_towards(parts_[k], kLampFrame, w);
    return sum;
}

void FitBeam::at(const Vector3d& w, BeamValue& value) const {
    if (kind_ == FitBeamKind::Table) return table_at(w, value);
    if (kind_ == FitBeamKind::Cosine) return cosine_at(w, value);
    value.intensity = intensity_with(c_, w);
    value.first = 0;
    value.by.assign(c_.size(), 0.0);
    const Vector3d one_way = w.unitOrthogonal();
    value.gradient.setZero();
    for (const Vector3d& way : {one_way, Vector3d(w.cross(one_way))}) {
        const double rise =
            intensity_with(c_, w + kSteps * way) - intensity_with(c_, w - kSteps * way);
        value.gradient += rise / (2.0 * kSteps) * way;
    }
    for (std::size_t k = 0; k < c_.size(); ++k) {
        if (kind_ == FitBeamKind::Cones) {
            value.by[k] = intensity_towards(parts_[k], kLampFrame, w);
            continue;
        }
        std::vector<double> more = c_;
        std::vector<double> less = c_;
        more[k] *= 1.0 + kSteps;
        less[k] *= 1.0 - kSteps;
        value.by[k] = (intensity_with(more, w) - intensity_with(less, w)) / (2.0 * kSteps * c_[k]);
    }
}

FitBeam::Fitted FitBeam::fitted() const {
    if (kind_ == FitBeamKind::Held) return {.beam = beam_, .flux = 1.0};
    if (kind_ == FitBeamKind::Cosine) return {.beam = cosine_beam(c_.front()), .flux = 1.0};
    if (kind_ == FitBeamKind::Table) {
        std::vector<double> theta_rad;
        std::vector<double> intensity;
        const double widest_rad = std::min(widest_rad_, 0.5 * pi);
        const int steps = static_cast<int>(std::ceil(widest_rad * 180.0 / pi / kFittedStep_deg));
        for (int i = 0; i <= steps; ++i) {
            theta_rad.push_back(widest_rad * i / steps);
            intensity.push_back(table_intensity_at(theta_rad.back()));
        }
        // Beyond, no light was seen: the table continues to the horizon, without an edge.
        const int more = static_cast<int>(std::ceil((0.5 * pi - widest_rad) / kKnot_rad));
        for (int i = 1; i <= more; ++i) {
            theta_rad.push_back(std::lerp(widest_rad, 0.5 * pi, static_cast<double>(i) / more));
            intensity.push_back(std::min(intensity.back(), table_intensity_at(theta_rad.back())));
        }
        const Beam beam = as_table(theta_rad, intensity);
        return {.beam = beam, .flux = 1.0 / beam.per_flux};
    }
    Beam beam = beam_;
    if (kind_ == FitBeamKind::Optics) {
        beam.pattern = optics_with(c_);
        beam = scaled_to_flux(std::move(beam));
        return {.beam = beam, .flux = beam_.per_flux / beam.per_flux};
    }
    const double flux = std::accumulate(c_.begin(), c_.end(), 0.0);
    beam.weights = ConeWeights::Flux;
    for (std::size_t k = 0; k < c_.size(); ++k) beam.cones[k].weight = c_[k] / flux;
    return {.beam = std::move(beam), .flux = flux};
}

}  // namespace aphotic
