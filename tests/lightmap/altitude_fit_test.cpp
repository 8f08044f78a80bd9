// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/altitude_fit.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(AltitudeFit, FindsAnExponentialWithinItsBounds) {
    const AltitudeFitter fitter(altitudes());
    for (const double b : {-4.0, -1.3, -0.2}) {
        std::vector<double> signal;
        for (const double h : altitudes()) signal.push_back(3.0 * std::exp(b * h) + 0.7);
        const AltitudeFit fit = fitter.fit(signal);
        EXPECT_NEAR(fit.b_per_m / b, 1.0, kSearch) << b;
        EXPECT_NEAR(fit.a / 3.0, 1.0, 10.0 * kSearch) << b;
        EXPECT_NEAR(fit.c / 0.7, 1.0, 10.0 * kSearch) << b;
        EXPECT_LT(fit.residual, kSearch) << b;
    }
}

// Straight lines and parabolas pull a free c far below zero or above the least signal. What the
// bounds leave is at least as good as any of 10^5 others within them.
TEST(AltitudeFit, IsTheBestWithinItsBounds) {
    const std::vector<double> altitude_m{1.0, 1.4, 2.0, 2.2, 2.9, 3.0};
    const AltitudeFitter fitter(altitude_m);
    const std::vector<std::vector<double>> signals{{5.0, 4.5, 3.4, 3.1, 1.8, 1.5},
                                                   {9.0, 1.2, 1.1, 1.3, 1.0, 1.2},
                                                   {1.0, 2.0, 3.0, 2.0, 1.0, 0.0},
                                                   {1.0, 1.1, 1.2, 1.3, 1.4, 1.5}};
    for (const std::vector<double>& signal : signals) {
        const AltitudeFit fit = fitter.fit(signal);
        const double least = *std::ranges::min_element(signal);
        EXPECT_GE(fit.a, 0.0);
        EXPECT_LE(fit.b_per_m, 0.0);
        EXPECT_GE(fit.c, 0.0);
        EXPECT_LE(fit.c, least);
        const auto squares = [&](double a, double b, double c) {
            double sum = 0.0;
            for (std::size_t i = 0; i < signal.size(); ++i)
                sum += std::pow(signal[i] - a * std::exp(b * altitude_m[i]) - c, 2);
            return sum;
        };
        const double found = squares(fit.a, fit.b_per_m, fit.c);
        for (int i = 0; i <= 50; ++i) {
            const double b = -std::pow(15.0, i / 25.0 - 1.0);
            for (int j = 0; j <= 20; ++j) {
                const double c = least * j / 20.0;
                for (int k = 0; k <= 100; ++k) {
                    const double a = 0.1 * k * std::exp(-b * altitude_m.front());
                    ASSERT_LE(found, squares(a, b, c) * (1.0 + kSearch))
                        << a << " " << b << " " << c;
                }
            }
        }
    }
    EXPECT_NEAR(fitter.fit(signals.back()).a, 1.25, 1e-12) << "their mean: they rise";
    EXPECT_EQ(fitter.fit(std::vector<double>(6, 0.0)).a, 0.0);
    EXPECT_EQ(fitter.fit(std::vector<double>(6, -1.0)).c, 0.0) << "noise about black";
}

TEST(AltitudeFit, TakesFourAltitudesAtLeast) {
    EXPECT_THROW(AltitudeFitter({1.0, 2.0, 3.0}), InputError);
}

}  // namespace
}  // namespace aphotic::altitude_fit_test
