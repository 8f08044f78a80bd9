// SPDX-License-Identifier: BSD-3-Clause
#include "base/gauss_rule.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::gauss_rule_test {
namespace {

constexpr double kRounding = 64.0 * 0x1p-53;  // of up to 64 terms that add up to 1 at most

TEST(GaussRule, IsExactForPolynomials) {
    for (unsigned points = 1; points <= 64; ++points) {
        for (unsigned degree = 0; degree < 2 * points; ++degree) {
            double sum = 0.0;
            for (const GaussNode& node : gauss_rule(points))
                sum += node.weight * std::pow(node.at, degree);
            EXPECT_NEAR(sum, 1.0 / (degree + 1.0), kRounding) << points << ", " << degree;
        }
    }
}

TEST(GaussRule, HasItsPointsInOrder) {
    EXPECT_TRUE(gauss_rule(0).empty());
    EXPECT_EQ(gauss_rule(1).front().at, 0.5);
    const auto& two = gauss_rule(2);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_NEAR(two[0].at, 0.5 - 1.0 / std::sqrt(12.0), kRounding);
    EXPECT_NEAR(two[1].at, 0.5 + 1.0 / std::sqrt(12.0), kRounding);
}

}  // namespace
}  // namespace aphotic::gauss_rule_test
