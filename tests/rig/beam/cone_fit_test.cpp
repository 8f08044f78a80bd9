// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/cone_fit.h"

#include "base/degrees.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::cone_fit_test {
namespace {

// Half angles on the grid: what went in comes out.
TEST(ConeFit, FindsConesThatAreThere) {
    const Beam beam{
        .name = "b",
        .cones = {{.part = "a", .half_angle_rad = 10.0 * kRadiansPerDegree, .weight = 0.2},
                  {.part = "b", .half_angle_rad = 26.5 * kRadiansPerDegree, .weight = 0.3},
                  {.part = "c", .half_angle_rad = 90.0 * kRadiansPerDegree, .weight = 0.5}}};
    const ConeFit fit = fit_cones(beam, 3);
    ASSERT_EQ(fit.cones.size(), 3U);
    constexpr double kMidpoints = 1e-5;  // of the rings
    EXPECT_LT(fit.error, 1e-4);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_DOUBLE_EQ(fit.cones[k].half_angle_rad, beam.cones[k].half_angle_rad);
        EXPECT_NEAR(fit.cones[k].weight, beam.cones[k].weight, kMidpoints);
    }
    // More do not help.
    EXPECT_LE(fit_cones(beam, 5).error, fit.error + 1e-9);
}

// cos^2 by one cone of 90 degrees, A cos: the best A is the integral of c^3 by that of c^2, 3/4,
// and what is left of the integral of c^4 is 1/5 - (1/4)^2 3 of 1/5: a sixteenth.
TEST(ConeFit, HasTheErrorOfTheProjection) {
    const Beam beam{.name = "b",
                    .cones = {{.part = "a",
                               .half_angle_rad = 90.0 * kRadiansPerDegree,
                               .weight = 1.0,
                               .exponent = 2.0}}};
    const ConeFit one = fit_cones(beam, 1);
    // A narrower cone may do better than that of 90 degrees, never worse.
    EXPECT_LE(one.error, std::sqrt(1.0 / 16.0) + 1e-5);
    double before = one.error;
    for (const int count : {2, 3, 5, 8}) {
        const double error = fit_cones(beam, count).error;
        EXPECT_LT(error, before) << count;
        before = error;
    }
    // Steps approximate a slope as one over their number.
    EXPECT_LT(before, 2.0 * one.error / 8.0);
}

}  // namespace
}  // namespace aphotic::cone_fit_test
