// SPDX-License-Identifier: BSD-3-Clause
#include "base/offered.h"

#include "base/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace aphotic::offered_test {
namespace {

TEST(Offered, IsRoundedOutwardInFewDigits) {
    EXPECT_EQ(at_least(0.0464801), 0.0465);
    EXPECT_EQ(at_least(0.0464301), 0.0465);
    EXPECT_EQ(at_most(0.0464801), 0.0464);
    EXPECT_EQ(at_least(0.1), 0.1);
    EXPECT_EQ(at_most(0.1), 0.1);
    EXPECT_EQ(at_least(9.991), 10.0);
    EXPECT_EQ(at_least(0.09996), 0.1);
    EXPECT_EQ(at_least(-1.2345), -1.23);
    EXPECT_EQ(at_most(-1.2345), -1.24);
    EXPECT_EQ(at_least(1234567.8, 6), 1234570.0);
    EXPECT_EQ(at_least(0.0), 0.0);
    EXPECT_TRUE(std::isinf(at_least(std::numeric_limits<double>::infinity())));
}

TEST(Offered, HoldsWhenItIsTyped) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> magnitude(-12.0, 12.0);
    for (int i = 0; i < 2000; ++i) {
        const double value = std::pow(10.0, magnitude(random)) * (i % 2 == 0 ? 1.0 : -1.0);
        for (const int digits : {2, 3, 6}) {
            const double step = std::abs(value) * std::pow(10.0, 1 - digits);
            const double least = at_least(value, digits);
            EXPECT_EQ(least, rounded_to_digits(least, digits));
            EXPECT_GE(least, value);
            EXPECT_LE(least - value, step);
            const double most = at_most(value, digits);
            EXPECT_EQ(most, rounded_to_digits(most, digits));
            EXPECT_LE(most, value);
            EXPECT_LE(value - most, step);
        }
    }
}

}  // namespace
}  // namespace aphotic::offered_test
