// SPDX-License-Identifier: BSD-3-Clause
//
// Of a mean over as many images as there are groups, the halves' variance is the sample's over its
// size: exactly, for the halves are balanced.
#include "survey/fit/fit_halves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace aphotic::fit_halves_test {
namespace {

constexpr double kRounding = 1e-12;
constexpr std::size_t kGroups = kHalves + 1;

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> half_of(const std::vector<double>& values, std::size_t half) {
    std::vector<double> some;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (is_in_half(i, half)) some.push_back(values[i]);
    return some;
}

double variance_by_halves(const std::vector<double>& values) {
    return variances_by_halves([&](std::size_t half) {
        return Eigen::VectorXd::Constant(1, mean_of(half_of(values, half)));
    })(0);
}

// s^2 / n.
double variance_of_mean(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double squares = 0.0;
    for (const double value : values) squares += std::pow(value - mean, 2.0);
    const auto count = static_cast<double>(values.size());
    return squares / (count - 1.0) / count;
}

std::vector<double> drawn(std::size_t count) {
    std::mt19937_64 dice(7);
    std::normal_distribution<double> normal;
    std::vector<double> values(count);
    for (double& value : values) value = normal(dice);
    return values;
}

TEST(FitHalves, AreHalves) {
    for (std::size_t half = 1; half <= kHalves; ++half)
        EXPECT_EQ(half_of(drawn(kGroups), half).size(), kGroups / 2) << half;
    EXPECT_EQ(half_of(drawn(kGroups), 0).size(), kGroups);
}

TEST(FitHalves, AnyTwoShareAHalfOfTheirs) {
    for (std::size_t one = 1; one <= kHalves; ++one) {
        for (std::size_t other = 1; other < one; ++other) {
            std::size_t shared = 0;
            for (std::size_t i = 0; i < kGroups; ++i)
                shared += is_in_half(i, one) && is_in_half(i, other) ? 1 : 0;
            EXPECT_EQ(shared, kGroups / 4) << one << ' ' << other;
        }
    }
}

TEST(FitHalves, GiveTheVarianceOfAMean) {
    const std::vector<double> values = drawn(kGroups);
    const double wanted = variance_of_mean(values);
    EXPECT_NEAR(variance_by_halves(values), wanted, kRounding * wanted);
}

// Images beyond the groups' number join them in turn: of groups of like size it is the variance of
// the groups' mean.
TEST(FitHalves, GiveTheVarianceOfTheGroupsMean) {
    const std::vector<double> values = drawn(3 * kGroups);
    std::vector<double> means(kGroups, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) means[i % kGroups] += values[i] / 3.0;
    const double wanted = variance_of_mean(means);
    EXPECT_NEAR(variance_by_halves(values), wanted, kRounding * wanted);
}

}  // namespace
}  // namespace aphotic::fit_halves_test
