// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_beam.h"

#include "base/error.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

namespace aphotic::fit_beam_test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kRounding = 1e-13;
constexpr double kDifference =
    1e-6;  // of central differences of 1e-5, some with bends as large as 1e4
constexpr double kAlongTheSphere = 1e-10;  // roundings over such steps

Vector3d direction(double theta_rad, double phi_rad) {
    return {std::sin(theta_rad) * std::cos(phi_rad),
            std::sin(theta_rad) * std::sin(phi_rad),
            std::cos(theta_rad)};
}

double intensity(const FitBeam& beam, const VectorXd& shares, const Vector3d& w) {
    std::vector<BeamPartValue> values;
    beam.at(w, true, values);
    double sum = 0.0;
    for (const BeamPartValue& value : values)
        sum += shares(static_cast<Eigen::Index>(value.part)) * value.value;
    return sum;
}

// B-splines of even knots add up to 1, and the shares k^2 - 1/3 make the parabola of theta in
// steps.
TEST(FitBeam, SplinesMakeAParabola) {
    const FitBeam beam = FitBeam::table(12, 1.0);
    const VectorXd ones = VectorXd::Ones(12);
    VectorXd squares(12);
    for (Eigen::Index k = 0; k < 12; ++k) squares(k) = static_cast<double>(k * k) - 1.0 / 3.0;
    for (const double theta : {0.0, 0.05, 0.1, 0.33, 0.77, 0.999, 1.0}) {
        EXPECT_NEAR(intensity(beam, ones, direction(theta, 1.0)), 1.0, kRounding);
        EXPECT_NEAR(intensity(beam, squares, direction(theta, -2.0)), 100.0 * theta * theta, 1e-11);
    }
    EXPECT_EQ(intensity(beam, ones, direction(1.01, 0.0)), 0.0);
}

// A lit square behind a lens out of focus.
FitBeam lens() {
    Beam beam;
    beam.pattern = BeamOptics{.along_m = 0.03,
                              .across_m = 0.06,
                              .focal_length_m = 0.065,
                              .distance_m = 0.05,
                              .aperture_m = 0.065};
    return FitBeam::optics(scaled_to_flux(std::move(beam)));
}

void expect_gradient(const FitBeam& beam, const VectorXd& shares) {
    std::mt19937_64 dice(3);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    for (int trial = 0; trial < 40; ++trial) {
        const Vector3d w = direction(0.9 * even(dice), 2.0 * pi * even(dice));
        std::vector<BeamPartValue> values;
        beam.at(w, true, values);
        Vector3d gradient = Vector3d::Zero();
        for (const BeamPartValue& value : values)
            gradient += shares(static_cast<Eigen::Index>(value.part)) * value.gradient;
        // Across the direction, along which alone it may turn.
        const Vector3d side = w.cross(Vector3d(0.3, 0.2, 0.9)).normalized();
        constexpr double kStep = 1e-5;
        const double wanted = (intensity(beam, shares, (w + kStep * side).normalized()) -
                               intensity(beam, shares, (w - kStep * side).normalized())) /
                              (2.0 * kStep);
        EXPECT_NEAR(gradient.dot(side), wanted, kDifference * shares.maxCoeff());
        EXPECT_NEAR(gradient.dot(w), 0.0, kAlongTheSphere);
    }
}

TEST(FitBeam, GradientsAreThoseOfTheIntensity) {
    expect_gradient(FitBeam::table(12, 1.0), VectorXd::LinSpaced(12, 3.0, 0.5));
    expect_gradient(FitBeam::cosine(7.0), VectorXd::Ones(1));
    expect_gradient(lens(), VectorXd::Ones(1));
}

// Of cos^n over the half sphere the flux is 2 pi/(n + 1).
TEST(FitBeam, ACosineHasTheFluxOfItsShare) {
    const FitBeam beam = FitBeam::cosine(4.0);
    EXPECT_NEAR(intensity(beam, VectorXd::Ones(1), Vector3d::UnitZ()), 5.0 / (2.0 * pi), kRounding);
    const FitBeam::Fitted fitted = beam.beam_of(VectorXd::Constant(1, 3.0));
    EXPECT_NEAR(fitted.flux, 3.0, kRounding);
    EXPECT_NEAR(flux_of(fitted.beam), 1.0, 1e-9);
}

// What is written shines as what was fitted: lines between half degrees of a spline whose knots are
// five apart, step^2/8 times its bend.
TEST(FitBeam, ItsTableShinesAlike) {
    constexpr double kBetweenRows = 2e-4;
    const FitBeam beam = FitBeam::table(14, 1.05);
    VectorXd shares(14);
    for (Eigen::Index k = 0; k < 14; ++k) shares(k) = std::exp(-0.03 * static_cast<double>(k * k));
    const FitBeam::Fitted fitted = beam.beam_of(shares);
    const BeamFrame frame{
        .axis = Vector3d::UnitZ(), .along = Vector3d::UnitX(), .across = Vector3d::UnitY()};
    for (double theta = 0.003; theta < 1.0; theta += 0.017) {
        const Vector3d w = direction(theta, 0.4);
        EXPECT_NEAR(fitted.flux * intensity_towards(fitted.beam, frame, w),
                    intensity(beam, shares, w),
                    kBetweenRows);
    }
}

// What is written has a flux of its own, of lenses other than the rig's, too.
TEST(FitBeam, ItsLensShinesAlike) {
    FitBeam beam = lens();
    beam.shape(0) = 0.08;
    beam.shape(1) = 0.04;
    const VectorXd shares = VectorXd::Constant(1, 3.0);
    const FitBeam::Fitted fitted = beam.beam_of(shares);
    EXPECT_NEAR(flux_of(fitted.beam), 1.0, 1e-9);
    const BeamFrame frame{
        .axis = Vector3d::UnitZ(), .along = Vector3d::UnitX(), .across = Vector3d::UnitY()};
    for (double theta = 0.0; theta < 1.0; theta += 0.05) {
        const Vector3d w = direction(theta, 0.4);
        EXPECT_NEAR(fitted.flux * intensity_towards(fitted.beam, frame, w),
                    intensity(beam, shares, w),
                    1e-12);
    }
}

TEST(FitBeam, RefusesWhatTheRigHasNot) {
    EXPECT_THROW(static_cast<void>(FitBeam::optics(Beam{})), InputError);
    EXPECT_THROW(static_cast<void>(FitBeam::cones(Beam{}, 0.02)), InputError);
}

}  // namespace
}  // namespace aphotic::fit_beam_test
