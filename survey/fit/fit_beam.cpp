// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_beam.h"

#include "base/error.h"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kOnAxis = 1e-12;
constexpr double kSteps = 1e-5;  // of central differences, of directions and logarithms
// A table starts at this share of the brightest or more, since the logarithm of 0 is undefined.
constexpr double kDimmest = 0.02;
constexpr double kScaleHeld = 0.01;  // the relative error to which the scale of a beam is held

const BeamFrame kLampFrame{
    .axis = Vector3d::UnitZ(), .along = Vector3d::UnitX(), .across = Vector3d::UnitY()};

Vector3d direction_at(double theta_rad) {
    return {std::sin(theta_rad), 0.0, std::cos(theta_rad)};
}

// The splines that are not 0 at a place, given in steps from the axis, by knot from `first` on, and
// their slopes over the step. Knot -1 is knot 1, mirrored.
struct Splines {
    std::size_t first = 0;
    std::array<double, 4> value{};
    std::array<double, 4> slope{};
};
Splines splines_at(double place, std::size_t count) {
    const std::size_t cell = std::min(static_cast<std::size_t>(place), count - 3);
    const double u = place - static_cast<double>(cell);
    const double v = 1.0 - u;
    const std::array<double, 4> value{v * v * v / 6.0,
                                      (4.0 + u * u * (3.0 * u - 6.0)) / 6.0,
                                      (4.0 + v * v * (3.0 * v - 6.0)) / 6.0,
                                      u * u * u / 6.0};
    const std::array<double, 4> slope{
        -0.5 * v * v, u * (1.5 * u - 2.0), -v * (1.5 * v - 2.0), 0.5 * u * u};
    if (cell > 0) return {.first = cell - 1, .value = value, .slope = slope};
    return {.first = 0,
            .value = {value[1], value[2] + value[0], value[3], 0.0},
            .slope = {slope[1], slope[2] + slope[0], slope[3], 0.0}};
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

// About the rig's, each by itself; for cones also the sum of their changes.
BeamPrior prior_about(const std::vector<double>& c, bool holds_sum) {
    const auto count = std::ssize(c);
    BeamPrior prior{.rows = MatrixXd::Identity(count, count) / kShapeSpread,
                    .means = VectorXd::Map(c.data(), count) / kShapeSpread};
    if (!holds_sum) return prior;
    const VectorXd shares = VectorXd::Map(c.data(), count).array().exp();
    prior.rows.conservativeResize(count + 1, count);
    prior.rows.row(count) = shares.transpose() / (shares.sum() * kScaleHeld);
    prior.means.conservativeResize(count + 1);
    prior.means(count) = prior.rows.row(count).dot(VectorXd::Map(c.data(), count));
    return prior;
}

}  // namespace

FitBeam::FitBeam(FitBeamKind kind, const Beam& beam, double widest_rad, double block_rad)
    : kind_(kind), widest_rad_(kind == FitBeamKind::Table ? widest_rad : 0.5 * pi), beam_(beam) {
    if (kind == FitBeamKind::Table) {
        begin_table();
    } else if (kind == FitBeamKind::Cones) {
        if (beam.cones.empty())
            throw InputError("beam '{}': found one that is not a sum of cones; allowed: cones",
                             beam.name);
        soften_cones(block_rad);
        c_ = shares_;
        prior_ = prior_about(c_, true);
    } else if (kind == FitBeamKind::Held) {
        soften_cones(block_rad);
    } else if (kind == FitBeamKind::Cosine) {
        c_ = {std::log(std::max(1.0, beam.cones.empty() ? 1.0 : beam.cones.front().exponent))};
        prior_ = prior_about(c_, false);
        prior_.rows /= 3.0;  // a rig of another kind hardly constrains it
        prior_.means /= 3.0;
    } else if (kind == FitBeamKind::Optics) {
        const auto* optics = std::get_if<BeamOptics>(&beam.pattern);
        if (optics == nullptr)
            throw InputError("beam '{}': found one without optics; allowed: optics", beam.name);
        c_ = {std::log(optics->focal_length_m), std::log(optics->distance_m)};
        prior_ = prior_about(c_, false);
    }
}

void FitBeam::soften_cones(double block_rad) {
    for (const Cone& cone : beam_.cones) {
        Beam alone = beam_;
        alone.cones = {cone};
        shares_.push_back(std::log(std::max(flux_of(alone), 1e-3)));
        alone.weights = ConeWeights::Flux;
        alone.cones = {softened(cone, kSoftEdge * block_rad)};
        alone.cones.front().weight = 1.0;
        cones_.push_back(alone);
    }
}

// The table closest to the rig's beam under the prior of tables.
void FitBeam::begin_table() {
    const auto count = static_cast<Index>(std::max(4.0, std::ceil(widest_rad_ / kKnot_rad) + 2.0));
    widest_rad_ = static_cast<double>(count - 2) * kKnot_rad;
    constexpr int kPerKnot = 4;
    const Index places = kPerKnot * (count - 2) + 1;
    std::vector<double> seen;
    for (Index i = 0; i < places; ++i)
        seen.push_back(intensity_towards(
            beam_,
            kLampFrame,
            direction_at(std::min(0.5 * pi, static_cast<double>(i) * kKnot_rad / kPerKnot))));
    const double brightest = std::ranges::max(seen);
    // Second differences, on the axis with the mirrored knot.
    MatrixXd second = MatrixXd::Zero(count - 1, count);
    for (Index k = 0; k + 1 < count; ++k) {
        second(k, k) -= 2.0;
        second(k, k + 1) += 1.0;
        second(k, std::abs(k - 1)) += 1.0;
    }
    second /= kRoughness;
    MatrixXd rows = MatrixXd::Zero(places + count - 1, count);
    VectorXd wanted = VectorXd::Zero(places + count - 1);
    Eigen::RowVectorXd scale = Eigen::RowVectorXd::Zero(count);
    for (Index i = 0; i < places; ++i) {
        const double place = static_cast<double>(i) / kPerKnot;
        const Splines splines = splines_at(place, static_cast<std::size_t>(count));
        const double lit = std::max(seen[static_cast<std::size_t>(i)], kDimmest * brightest);
        for (Index k = 0; k < 4; ++k) {
            const Index knot = std::min(static_cast<Index>(splines.first) + k, count - 1);
            const double value = splines.value[static_cast<std::size_t>(k)];
            rows(i, knot) += value;
            scale(knot) += value * lit * std::sin(place * kKnot_rad);
        }
        wanted(i) = std::log(lit);
    }
    rows.bottomRows(count - 1) = second;
    const VectorXd c = rows.colPivHouseholderQr().solve(wanted);
    c_.assign(c.begin(), c.end());
    prior_.rows.resize(count, count);
    prior_.rows << second, scale / (scale.sum() * kScaleHeld);
    prior_.means = VectorXd::Zero(count);
    prior_.means(count - 1) = prior_.rows.row(count - 1).dot(c);
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
    const Splines splines = splines_at(place, c_.size());
    value.first = splines.first;
    const std::size_t count = std::min<std::size_t>(4, c_.size() - splines.first);
    value.by.assign(count, 0.0);
    double log_intensity = 0.0;
    double slope = 0.0;
    const double beyond = std::max(0.0, theta_rad - widest_rad_) / kKnot_rad;
    for (std::size_t k = 0; k < count; ++k) {
        value.by[k] = splines.value[k] + beyond * splines.slope[k];
        log_intensity += c_[splines.first + k] * value.by[k];
        slope += c_[splines.first + k] * splines.slope[k] / kKnot_rad;
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
    const double n = std::exp(c_.front());
    value.intensity = (n + 1.0) / (2.0 * pi) * std::pow(w.z(), n);
    value.gradient = n * value.intensity / w.z() * (Vector3d::UnitZ() - w.z() * w);
    value.by[0] = n * value.intensity * (1.0 / (n + 1.0) + std::log(w.z()));
}

BeamOptics FitBeam::optics_with(const std::vector<double>& c) const {
    BeamOptics optics = std::get<BeamOptics>(beam_.pattern);
    optics.focal_length_m = std::exp(c[0]);
    optics.distance_m = std::exp(c[1]);
    return optics;
}

// Optics with the rig's own flux: one for each lens would take long, and the powers compensate.
double FitBeam::intensity_with(const std::vector<double>& c, const Vector3d& w) const {
    if (cones_.empty() && kind_ == FitBeamKind::Held)
        return intensity_towards(beam_, kLampFrame, w);
    if (kind_ == FitBeamKind::Optics) {
        const auto view = pattern_view(beam_, kLampFrame, w);
        return view ? beam_.per_flux * view->factor *
                          optics_intensity(optics_with(c), view->direction)
                    : 0.0;
    }
    double sum = 0.0;
    const std::vector<double>& shares = kind_ == FitBeamKind::Held ? shares_ : c;
    for (std::size_t k = 0; k < shares.size(); ++k)
        sum += std::exp(shares[k]) * intensity_towards(cones_[k], kLampFrame, w);
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
            value.by[k] = std::exp(c_[k]) * intensity_towards(cones_[k], kLampFrame, w);
            continue;
        }
        std::vector<double> more = c_;
        std::vector<double> less = c_;
        more[k] += kSteps;
        less[k] -= kSteps;
        value.by[k] = (intensity_with(more, w) - intensity_with(less, w)) / (2.0 * kSteps);
    }
}

FitBeam::Fitted FitBeam::fitted() const {
    if (kind_ == FitBeamKind::Held) return {.beam = beam_, .flux = 1.0};
    if (kind_ == FitBeamKind::Cosine)
        return {.beam = cosine_beam(std::exp(c_.front())), .flux = 1.0};
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
    double flux = 0.0;
    for (const double c : c_) flux += std::exp(c);
    beam.weights = ConeWeights::Flux;
    for (std::size_t k = 0; k < c_.size(); ++k) beam.cones[k].weight = std::exp(c_[k]) / flux;
    return {.beam = std::move(beam), .flux = flux};
}

}  // namespace aphotic
