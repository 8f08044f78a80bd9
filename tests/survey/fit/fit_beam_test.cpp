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
using std::numbers::pi;

constexpr double kRounding = 1e-12;
// Central differences of 1e-5, some of intensities with bends as large as 1e4, and those by which
// beams of optics and cones are differentiated.
constexpr double kDifference = 1e-5;
constexpr double kAlongTheSphere = 1e-9;
// Lines between the half degrees of a table, step^2/8 times the bend of its logarithm.
constexpr double kBetweenRows = 3e-4;
constexpr double kBlock_rad = 0.02;
constexpr double kWidest_rad = 1.0;

Vector3d direction(double theta_rad, double phi_rad) {
    return {std::sin(theta_rad) * std::cos(phi_rad),
            std::sin(theta_rad) * std::sin(phi_rad),
            std::cos(theta_rad)};
}

double intensity(const FitBeam& beam, const Vector3d& w) {
    BeamValue value;
    beam.at(w, value);
    return value.intensity;
}

Beam cosine(double exponent) {
    Beam beam;
    beam.cones = {{.part = "all", .half_angle_rad = 0.5 * pi, .weight = 1.0, .exponent = exponent}};
    return scaled_to_flux(std::move(beam));
}

// A lit square behind a lens out of focus.
Beam lens() {
    Beam beam;
    beam.pattern = BeamOptics{.along_m = 0.03,
                              .across_m = 0.06,
                              .focal_length_m = 0.065,
                              .distance_m = 0.05,
                              .aperture_m = 0.065};
    return scaled_to_flux(std::move(beam));
}

Beam soft_cones() {
    Beam beam;
    beam.cones = {{.part = "all", .half_angle_rad = 0.5 * pi, .weight = 0.7, .exponent = 3.0},
                  {.part = "narrow", .half_angle_rad = 0.5 * pi, .weight = 0.3, .exponent = 12.0}};
    return scaled_to_flux(std::move(beam));
}

// B-splines of even knots add up to 1, and the coefficients k^2 - 1/3 make the parabola of theta in
// knots: here the logarithm is 2 - (theta/0.5)^2.
TEST(FitBeam, SplinesMakeAParabola) {
    FitBeam beam(FitBeamKind::Table, cosine(4.0), kWidest_rad, kBlock_rad);
    const double knots = std::pow(kKnot_rad / 0.5, 2.0);
    for (std::size_t k = 0; k < beam.coefficients().size(); ++k)
        beam.coefficient(k) = 2.0 - knots * (static_cast<double>(k * k) - 1.0 / 3.0);
    for (const double theta : {0.0, 0.05, 0.1, 0.33, 0.77, 0.999})
        EXPECT_NEAR(std::log(intensity(beam, direction(theta, 2.0))),
                    2.0 - std::pow(theta / 0.5, 2.0),
                    kRounding)
            << theta;
}

void expect_derivatives(FitBeam beam) {
    std::mt19937_64 dice(3);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    constexpr double kStep = 1e-5;
    for (int trial = 0; trial < 40; ++trial) {
        const Vector3d w = direction(0.9 * even(dice), 2.0 * pi * even(dice));
        BeamValue value;
        beam.at(w, value);
        const Vector3d side = w.cross(Vector3d(0.3, 0.2, 0.9)).normalized();
        const double slope = (intensity(beam, (w + kStep * side).normalized()) -
                              intensity(beam, (w - kStep * side).normalized())) /
                             (2.0 * kStep);
        EXPECT_NEAR(value.gradient.dot(side), slope, kDifference * (1.0 + std::abs(slope)));
        EXPECT_NEAR(value.gradient.dot(w), 0.0, kAlongTheSphere * (1.0 + value.gradient.norm()));
        for (std::size_t k = 0; k < beam.coefficients().size(); ++k) {
            const double was = beam.coefficients()[k];
            const double step = beam.kind() == FitBeamKind::Table ? kStep : kStep * was;
            beam.coefficient(k) = was + step;
            const double more = intensity(beam, w);
            beam.coefficient(k) = was - step;
            const double wanted = (more - intensity(beam, w)) / (2.0 * step);
            beam.coefficient(k) = was;
            const bool is_there = k >= value.first && k < value.first + value.by.size();
            EXPECT_NEAR(is_there ? value.by[k - value.first] : 0.0,
                        wanted,
                        kDifference * (1.0 + std::abs(wanted)));
        }
    }
}

TEST(FitBeam, DerivativesAreThoseOfTheIntensity) {
    expect_derivatives({FitBeamKind::Table, cosine(4.0), kWidest_rad, kBlock_rad});
    expect_derivatives({FitBeamKind::Cosine, cosine(7.0), kWidest_rad, kBlock_rad});
    expect_derivatives({FitBeamKind::Cones, soft_cones(), kWidest_rad, kBlock_rad});
    expect_derivatives({FitBeamKind::Optics, lens(), kWidest_rad, kBlock_rad});
}

// Of cos^n over the half sphere the flux is 2 pi/(n + 1).
TEST(FitBeam, ACosineBeginsAsTheRigs) {
    const FitBeam beam(FitBeamKind::Cosine, cosine(4.0), kWidest_rad, kBlock_rad);
    EXPECT_NEAR(beam.coefficients().at(0), 4.0, kRounding);
    EXPECT_NEAR(intensity(beam, Vector3d::UnitZ()), 5.0 / (2.0 * pi), kRounding);
    EXPECT_NEAR(intensity(beam, direction(1.0, 0.3)),
                5.0 / (2.0 * pi) * std::pow(std::cos(1.0), 4.0),
                kRounding);
}

// What is written shines as what was fitted, and has a flux of 1.
TEST(FitBeam, WhatIsWrittenShinesAlike) {
    const BeamFrame frame{
        .axis = Vector3d::UnitZ(), .along = Vector3d::UnitX(), .across = Vector3d::UnitY()};
    for (FitBeam beam : {FitBeam{FitBeamKind::Table, cosine(4.0), kWidest_rad, kBlock_rad},
                         FitBeam{FitBeamKind::Cosine, cosine(4.0), kWidest_rad, kBlock_rad},
                         FitBeam{FitBeamKind::Cones, soft_cones(), kWidest_rad, kBlock_rad},
                         FitBeam{FitBeamKind::Optics, lens(), kWidest_rad, kBlock_rad}}) {
        beam.coefficient(0) *= 1.03;
        const FitBeam::Fitted fitted = beam.fitted();
        EXPECT_NEAR(flux_of(fitted.beam), 1.0, 1e-6);
        for (double theta = 0.003; theta < 0.98; theta += 0.017) {
            const Vector3d w = direction(theta, 0.4);
            EXPECT_NEAR(fitted.flux * intensity_towards(fitted.beam, frame, w),
                        intensity(beam, w),
                        kBetweenRows)
                << static_cast<int>(beam.kind()) << " at " << theta;
        }
    }
}

// Past the widest angle that images show, light falls as it did there: of cos^4 by 4 tan(theta) a
// radian, of its logarithm. It ends at the horizon.
TEST(FitBeam, AWrittenTableHasNoEdgeWhereImagesEnd) {
    const FitBeam beam(FitBeamKind::Table, cosine(4.0), kWidest_rad, kBlock_rad);
    const Beam written = beam.fitted().beam;
    const auto& table = std::get<BeamTable>(written.pattern);
    EXPECT_EQ(table.vertical_rad.back(), 0.5 * pi);
    const auto at = [&](double theta_rad) {
        return intensity_towards(
            written, frame_about(Vector3d::UnitZ()), direction(theta_rad, 0.0));
    };
    constexpr double kOfSplines = 0.03;  // their last slope, of a function that steepens
    EXPECT_NEAR(at(kWidest_rad + 0.1) / at(kWidest_rad),
                std::exp(-0.4 * std::tan(kWidest_rad)),
                kOfSplines);
}

// Second differences of a table by kRoughness, and one row that holds its mean over what it lights:
// a straight line of the same mean costs nothing.
TEST(FitBeam, ATablesPriorIsItsRoughness) {
    const FitBeam beam(FitBeamKind::Table, cosine(4.0), kWidest_rad, kBlock_rad);
    const BeamPrior& prior = beam.prior();
    const auto size = std::ssize(beam.coefficients());
    Eigen::VectorXd line(size);
    for (Eigen::Index k = 0; k < size; ++k) line(k) = static_cast<double>(k);
    Eigen::VectorXd bent = Eigen::VectorXd::Zero(size);
    bent(4) = 1.0;
    // 1, -2, 1 of three differences.
    EXPECT_NEAR((prior.rows * bent).squaredNorm() -
                    std::pow((prior.rows.row(prior.rows.rows() - 1) * bent)(0), 2.0),
                6.0 / (kRoughness * kRoughness),
                1e-6);
    EXPECT_LT((prior.rows.middleRows(1, size - 3) * line).norm(), 1e-9);
}

TEST(FitBeam, RefusesWhatTheRigHasNot) {
    for (const FitBeamKind kind : {FitBeamKind::Optics, FitBeamKind::Cones})
        EXPECT_THROW(static_cast<void>(FitBeam(kind, Beam{}, kWidest_rad, kBlock_rad)), InputError);
}

}  // namespace
}  // namespace aphotic::fit_beam_test
