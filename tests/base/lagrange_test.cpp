// SPDX-License-Identifier: BSD-3-Clause
#include "base/lagrange.h"

#include <gtest/gtest.h>

namespace aphotic::lagrange_test {
namespace {

constexpr double kRounding = 1e-13;  // of terms of up to 20

double cubic(double x) {
    return 2.0 - 3.0 * x + 0.5 * x * x - 0.25 * x * x * x;
}

TEST(Lagrange, IsExactForACubic) {
    for (const double a : {-0.7, 0.0, 0.3, 1.5, 2.0, 3.4}) {
        double sum = 0.0;
        for (int k = 0; k < 4; ++k)
            sum += lagrange_weights(a)[static_cast<std::size_t>(k)] * cubic(k);
        EXPECT_NEAR(sum, cubic(a), kRounding) << a;
    }
}

TEST(Lagrange, GoesThroughItsNodes) {
    EXPECT_EQ(lagrange_weights(2.0), (std::array<double, 4>{0.0, 0.0, 1.0, 0.0}));
}

}  // namespace
}  // namespace aphotic::lagrange_test
