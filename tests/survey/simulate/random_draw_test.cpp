// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/random_draw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace aphotic::random_draw_test {
namespace {

// Pearson's chi squared of counts against Poisson's probabilities, whose mean is the number of
// classes less one and whose variance twice that.
void expect_poisson(double mu) {
    constexpr int kDraws = 100'000;
    constexpr double kFewest = 20.0;  // expected in a class, or it is left out
    std::vector<int> counts(static_cast<std::size_t>(mu + 20.0 * std::sqrt(mu) + 20.0));
    RandomSource random = random_of(3, 1);
    for (int i = 0; i < kDraws; ++i) ++counts.at(static_cast<std::size_t>(poisson(random, mu)));
    double chi_squared = 0.0;
    double classes = 0.0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        const auto x = static_cast<double>(k);
        const double expected = kDraws * std::exp(x * std::log(mu) - mu - std::lgamma(x + 1.0));
        if (expected < kFewest) continue;
        chi_squared += std::pow(counts[k] - expected, 2) / expected;
        classes += 1.0;
    }
    EXPECT_NEAR(chi_squared, classes, 4.0 * std::sqrt(2.0 * classes)) << mu;
}

TEST(RandomDraw, HasPoissonsProbabilities) {
    // Either side of where the method changes, and where the table of factorials ends.
    for (const double mu : {0.3, 4.0, 9.99, 10.01, 35.0, 400.0, 9000.0}) expect_poisson(mu);
}

TEST(RandomDraw, OfNothingIsNothing) {
    RandomSource random = random_of(3, 1);
    EXPECT_EQ(poisson(random, 0.0), 0.0);
    EXPECT_EQ(poisson(random, -1.0), 0.0);
}

TEST(RandomDraw, IsNormalOfVarianceOne) {
    constexpr int kDraws = 100'000;
    RandomSource random = random_of(3, 1);
    double sum = 0.0;
    double squares = 0.0;
    int within_one = 0;
    for (int i = 0; i < kDraws; ++i) {
        const double x = normal(random);
        sum += x;
        squares += x * x;
        if (std::abs(x) < 1.0) ++within_one;
    }
    EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / std::sqrt(kDraws));
    EXPECT_NEAR(squares / kDraws, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
    const double p = std::erf(std::sqrt(0.5));
    EXPECT_NEAR(within_one / double{kDraws}, p, 4.0 * std::sqrt(p * (1.0 - p) / kDraws));
}

TEST(RandomDraw, DependsOnSeedAndImageAlone) {
    EXPECT_EQ(random_of(1, 2)(), random_of(1, 2)());
    EXPECT_NE(random_of(1, 2)(), random_of(1, 3)());
    EXPECT_NE(random_of(1, 2)(), random_of(2, 2)());
    EXPECT_NE(random_of(1, 2)(), random_of((1ULL << 32U) + 1, 2)());
}

}  // namespace
}  // namespace aphotic::random_draw_test
