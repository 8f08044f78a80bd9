// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/altitude_fit.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::altitude_fit_test {
namespace {

// The search over b ends at 16 bits.
constexpr double kSearch = 1e-3;

std::vector<double> altitudes() {
    std::vector<double> altitude_m;
    for (int i = 10; i <= 40; ++i) altitude_m.push_back(0.1 * i);
    return altitude_m;
}

TEST(AltitudeFit, FindsTheExponentialThatTheLightIs) {
    const AltitudeFitter fitter(altitudes());
    for (const double b : {-4.0, -1.3, -0.2, 0.5, 2.0}) {
        std::vector<double> signal;
        for (const double h : altitudes()) signal.push_back(3.0 * std::exp(b * h) + 0.7);
        const AltitudeFit fit = fitter.fit(signal);
        EXPECT_NEAR(fit.b_per_m / b, 1.0, kSearch) << b;
        EXPECT_NEAR(fit.a / 3.0, 1.0, 10.0 * kSearch) << b;
        EXPECT_LT(fit.residual, kSearch) << b;
    }
}

// The residual is what a straight look says: rms of what is left, over the mean.
TEST(AltitudeFit, StatesItsResidual) {
    std::vector<double> signal;
    double sign = 1.0;
    for (const double h : altitudes()) {
        signal.push_back(2.0 * std::exp(-h) + 1.0 + 0.01 * sign);
        sign = -sign;
    }
    const AltitudeFit fit = AltitudeFitter(altitudes()).fit(signal);
    double squares = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < signal.size(); ++i) {
        const double h = altitudes()[i];
        squares += std::pow(signal[i] - (fit.a * std::exp(fit.b_per_m * h) + fit.c), 2);
        sum += signal[i];
    }
    const auto n = static_cast<double>(signal.size());
    EXPECT_NEAR(fit.residual, std::sqrt(squares / n) / (sum / n), 1e-9);
    // A wave that no exponential follows stays whole.
    EXPECT_NEAR(fit.residual * sum / n, 0.01, 0.001);
}

TEST(AltitudeFit, IsNothingOfNothing) {
    const AltitudeFit fit = AltitudeFitter(altitudes()).fit(std::vector<double>(31, 0.0));
    EXPECT_EQ(fit.a, 0.0);
    EXPECT_EQ(fit.residual, 0.0);
}

// However close they are, a and exp(b h) are numbers that a float holds.
TEST(AltitudeFit, OfCloseAltitudesIsFinite) {
    const std::vector<double> altitude_m{1.0, 1.004, 1.008, 1.012};
    std::vector<double> signal;
    for (const double h : altitude_m) signal.push_back(std::pow(h, -3));
    const AltitudeFit fit = AltitudeFitter(altitude_m).fit(signal);
    // The slowest rate bends twice as much as this light.
    constexpr double kBend = 2e-4;
    EXPECT_LT(fit.residual, kBend);
    EXPECT_TRUE(std::isfinite(static_cast<float>(fit.a)));
    EXPECT_GT(static_cast<float>(std::exp(fit.b_per_m * 1.0)), 0.0F);
    // And where most light is in one of them, no b is fast enough: it is told in the residual.
    const AltitudeFit step =
        AltitudeFitter(altitude_m).fit(std::vector<double>{1.0, 0.0, 0.0, 0.0});
    EXPECT_TRUE(std::isfinite(step.residual));
    EXPECT_TRUE(std::isfinite(static_cast<float>(step.a)));
    EXPECT_THROW(AltitudeFitter({1.0, 1.0001, 1.0002, 1.0003}), InputError);
}

TEST(AltitudeFit, TakesFourAltitudesAtLeast) {
    EXPECT_THROW(AltitudeFitter({1.0, 2.0, 3.0}), InputError);
}

}  // namespace
}  // namespace aphotic::altitude_fit_test
