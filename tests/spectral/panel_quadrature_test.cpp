// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/panel_quadrature.h"

#include "support/light_family.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace aphotic::panel_quadrature_test {
namespace {

constexpr WavelengthRange kRange{400.0, 700.0};
constexpr double kWidth_nm = 300.0;
// What the header states of a panel.
constexpr double kPanelError = 1e-10;
// What some thousand additions of numbers of one sign may lose.
constexpr double kRounding = 1e-13;

Water water_of(double first_per_m, double last_per_m) {
    return {.absorption_per_m = line(first_per_m, last_per_m)};
}

const Water kClear{.absorption_per_m = line(1.0, 1.0), .multiple = 0.0};

std::vector<QuadratureNode> nodes_of(const std::vector<const Spectrum*>& tables,
                                     const Water& water,
                                     double longest_path_m) {
    return panel_quadrature(light_panels(tables, water, 0.0, longest_path_m, nullptr, kRange));
}

// By the nodes, of exp(-K l).
double light_left(const Water& water, double path_m, double longest_path_m) {
    double sum = 0.0;
    for (const auto& [lambda_nm, width_nm] : nodes_of({}, water, longest_path_m)) {
        sum += width_nm * std::exp(-water.attenuation_per_m(lambda_nm) * path_m);
    }
    return sum;
}

// K a straight line from k0 to k1, all else 1:  W (exp(-k0 l) - exp(-k1 l)) / ((k1 - k0) l).
TEST(PanelQuadrature, IsTheClosedFormOfFallingLightOnEveryPathUpToTheLongest) {
    constexpr double kDark_per_m = 0.9;
    constexpr double kBright_per_m = 0.02;
    const Water red_is_dark = water_of(kBright_per_m, kDark_per_m);
    const Water blue_is_dark = water_of(kDark_per_m, kBright_per_m);
    for (const double longest_m : {1.0, 30.0, 700.0, 2e4}) {
        for (const double share : {1.0, 0.5, 0.1, 1e-2, 1e-3}) {
            const double path_m = share * longest_m;
            const double fall = (kDark_per_m - kBright_per_m) * path_m;
            const double right =
                kWidth_nm * std::exp(-kBright_per_m * path_m) * -std::expm1(-fall) / fall;
            for (const Water& water : {red_is_dark, blue_is_dark}) {
                EXPECT_NEAR(light_left(water, path_m, longest_m) / right, 1.0, kPanelError)
                    << path_m << " of " << longest_m << " m";
            }
        }
    }
}

// In water that leaves nothing of the dark half, most of the interval needs no panel.
TEST(PanelQuadrature, EndsWhereTheShortestPathsLightIsSpent) {
    const Water water = water_of(0.0, 1e4);
    const auto panels = light_panels({}, water, 1.0, 1.2, nullptr, kRange);
    EXPECT_LT(panels.back().last_nm, 410.0);
    double sum = 0.0;
    for (const auto& [lambda_nm, width_nm] : panel_quadrature(panels)) {
        sum += width_nm * std::exp(-water.attenuation_per_m(lambda_nm));
    }
    EXPECT_NEAR(sum / (kWidth_nm / 1e4), 1.0, kPanelError);
}

TEST(PanelQuadrature, IsExactForAProductOfSixLines) {
    const Spectrum rising = line(0.0, 1.0);
    double sum = 0.0;
    for (const auto& [lambda_nm, width_nm] : nodes_of({&rising}, kClear, 1.0)) {
        sum += width_nm * std::pow(rising.at(lambda_nm), 6.0);
    }
    EXPECT_NEAR(sum, kWidth_nm / 7.0, kRounding * kWidth_nm);
}

// Relative to the integral, so that what is steep is as right as what is flat: trapezia from 1e-300
// up to 1, a decade a nanometre.
TEST(PanelQuadrature, IsExactForAFilterThatRisesOverThreeHundredDecades) {
    std::vector<double> knots_nm;
    std::vector<double> values;
    for (int i = 0; i <= 300; ++i) {
        knots_nm.push_back(400.0 + i);
        values.push_back(std::pow(10.0, i - 300));
    }
    const Spectrum filter("steep", knots_nm, values);
    for (const int last : {1, 100, 299, 300}) {
        double right = 0.0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(last); ++i) {
            right += 0.5 * (values[i] + values[i + 1]);
        }
        double found = 0.0;
        for (const auto& [lambda_nm, width_nm] : nodes_of({&filter}, kClear, 1.0)) {
            if (lambda_nm < 400.0 + last) found += width_nm * filter.at(lambda_nm);
        }
        EXPECT_NEAR(found / right, 1.0, kRounding) << "up to " << 400 + last << " nm";
    }
}

TEST(PanelQuadrature, SeesALineBetweenKnotsThatAlmostCoincide) {
    constexpr double kHalf_nm = 1e-7;
    const Spectrum peak("peak",
                        {400.0, 550.0 - kHalf_nm, 550.0, 550.0 + kHalf_nm, 700.0},
                        {0.0, 0.0, 1e9, 0.0, 0.0});
    double sum = 0.0;
    for (const auto& [lambda_nm, width_nm] : nodes_of({&peak}, kClear, 1.0)) {
        EXPECT_TRUE(kRange.contains(lambda_nm)) << lambda_nm;
        sum += width_nm * peak.at(lambda_nm);
    }
    // The knots themselves are rounded to 2^-44 nm, a 1e-7th of the line's width.
    constexpr double kRoundedKnots = 1e-6;
    EXPECT_NEAR(sum, 1e9 * kHalf_nm, kRoundedKnots * 1e9 * kHalf_nm);
}

// exp(t lambda) over the range.
TEST(PanelQuadrature, FollowsATilt) {
    const Spectrum tilt = line(-3.0, 3.0);
    double sum = 0.0;
    for (const auto& [lambda_nm, width_nm] :
         panel_quadrature(light_panels({}, kClear, 1.0, 1.0, &tilt, kRange))) {
        sum += width_nm * std::exp(tilt.at(lambda_nm));
    }
    const double right = kWidth_nm * std::sinh(3.0) / 3.0;
    EXPECT_NEAR(sum / right, 1.0, kPanelError);
}

}  // namespace
}  // namespace aphotic::panel_quadrature_test
