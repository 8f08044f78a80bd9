// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_window.h"

#include <gtest/gtest.h>
#include <boost/math/quadrature/tanh_sinh.hpp>

#include <cmath>
#include <numbers>

namespace aphotic::beam_window_test {
namespace {

constexpr double kRightAngle_rad = 0.5 * std::numbers::pi;
const BeamWindow kBk7{.glass_index = 1.5185, .water_index = 1.3437};

// Straight through, by hand: of 1.5185 against 1 and against 1.3437, 4.24 % and 0.37 % come back.
TEST(BeamWindow, LetsThroughWhatTwoFacesDo) {
    const double outer = std::pow((1.5185 - 1.0) / (1.5185 + 1.0), 2);
    const double inner = std::pow((1.5185 - 1.3437) / (1.5185 + 1.3437), 2);
    const double both = (1.0 - outer) * (1.0 - inner) / (1.0 - outer * inner);
    EXPECT_NEAR(transmittance_by_cosine(kBk7, 1.0), both, 1e-14);
    EXPECT_NEAR(window_factor(kBk7, 1.0), both * 1.3437 * 1.3437, 1e-13);
}

// A window as water on both sides, or of air, is none.
TEST(BeamWindow, OfNothingChangesNothing) {
    const BeamWindow none{.glass_index = 1.0, .water_index = 1.0};
    for (const double angle_rad : {0.0, 0.3, 1.0, 1.5}) {
        EXPECT_NEAR(window_factor(none, std::cos(angle_rad)), 1.0, 1e-12) << angle_rad;
        EXPECT_NEAR(angle_in_air_rad(none, angle_rad), angle_rad, 1e-12);
    }
}

// The index 1 is air's: no glass, but one face to water, along which the light has a limit.
TEST(BeamWindow, OfAirHasItsLimitAlongTheFace) {
    const BeamWindow air{.glass_index = 1.0, .water_index = 1.3437};
    constexpr double kAlmost = 1e-9;
    EXPECT_NEAR(window_factor(air, 0.0) / window_factor(air, kAlmost), 1.0, 1e-7);
    const double reflected = std::pow(0.3437 / 2.3437, 2);
    EXPECT_NEAR(window_factor(air, 1.0), (1.0 - reflected) * 1.3437 * 1.3437, 1e-13);
}

// Light of p polarisation passes glass in air at Brewster's angle; s is reflected twice, each time
// by ((n^2 - 1)/(n^2 + 1))^2.
TEST(BeamWindow, HasBrewstersAngle) {
    const double n = 1.5;
    const double cos_brewster = 1.0 / std::sqrt(1.0 + n * n);
    const double r = std::pow((n * n - 1.0) / (n * n + 1.0), 2);
    const double s = (1.0 - r) / (1.0 + r);
    EXPECT_NEAR(transmittance_by_cosine({.glass_index = n, .water_index = 1.0}, cos_brewster) *
                    cos_brewster,
                0.5 * (1.0 + s),
                1e-13);
}

// Energy: what leaves in water is what the window lets through in air.
TEST(BeamWindow, KeepsTheFluxButWhatItReflects) {
    boost::math::quadrature::tanh_sinh<double> integrator;
    const auto in_air = [](double theta_rad) {
        const double cosine = std::cos(theta_rad);
        return transmittance_by_cosine(kBk7, cosine) * cosine * std::sin(theta_rad);
    };
    const auto in_water = [](double theta_rad) {
        const double sine = kBk7.water_index * std::sin(theta_rad);
        return window_factor(kBk7, std::sqrt(std::max(0.0, 1.0 - sine * sine))) *
               std::sin(theta_rad);
    };
    EXPECT_NEAR(integrator.integrate(in_water, 0.0, widest_in_water_rad(kBk7)),
                integrator.integrate(in_air, 0.0, kRightAngle_rad),
                1e-7);
}

TEST(BeamWindow, GrowsOutwards) {
    for (const BeamWindow& window : {kBk7,
                                     BeamWindow{.glass_index = 1.77, .water_index = 1.34},
                                     BeamWindow{.glass_index = 1.4, .water_index = 1.33}}) {
        double before = 0.0;
        for (int i = 0; i <= 9000; ++i) {
            const double factor = window_factor(window, std::cos(i * kRightAngle_rad / 9000));
            EXPECT_GE(factor, before * (1.0 - 1e-12)) << i;
            before = factor;
        }
    }
}

// 100 degrees in air are 70 in water, and the axis is 1.8 times as bright but for 4.6 %.
TEST(BeamWindow, MakesAHundredDegreesSeventy) {
    constexpr double kHalf_rad = 50.0 / 180.0 * std::numbers::pi;
    EXPECT_NEAR(angle_in_water_rad(kBk7, kHalf_rad) * 180.0 / std::numbers::pi, 34.8, 0.1);
    EXPECT_NEAR(angle_in_air_rad(kBk7, angle_in_water_rad(kBk7, kHalf_rad)), kHalf_rad, 1e-12);
    const auto seen = in_air(kBk7, {std::sin(0.5), 0.0, std::cos(0.5)});
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->direction.x(), 1.3437 * std::sin(0.5), 1e-14);
    EXPECT_FALSE(in_air(kBk7, {1.0, 0.0, 1.0 / 1.2}));  // 50 degrees
}

}  // namespace
}  // namespace aphotic::beam_window_test
