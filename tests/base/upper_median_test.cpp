// SPDX-License-Identifier: BSD-3-Clause
#include "base/upper_median.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::upper_median_test {
namespace {

double of(std::vector<double> numbers) {
    return upper_median(numbers);
}

TEST(UpperMedian, IsTheUpperOfTheTwoInTheMiddle) {
    EXPECT_EQ(of({7.0}), 7.0);
    EXPECT_EQ(of({5.0, -1.0, 2.0}), 2.0);
    EXPECT_EQ(of({4.0, 1.0, 3.0, 2.0}), 3.0);
    EXPECT_EQ(of({1.0, 9.0}), 9.0);
}

TEST(UpperMedian, OfNoneIsNone) {
    EXPECT_TRUE(std::isnan(of({})));
}

}  // namespace
}  // namespace aphotic::upper_median_test
