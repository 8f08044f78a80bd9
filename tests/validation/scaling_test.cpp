// SPDX-License-Identifier: BSD-3-Clause
#include "validation/scaling.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace aphotic::scaling_test {
namespace {

using Samples = std::vector<float>;

double scale_of(const Samples& a, const Samples& b, const std::vector<unsigned char>& marks = {}) {
    Scaling scaling;
    scaling.add(a, b, marks);
    return scaling.scale();
}

// 3 and 5 over 1 and 2: (3 + 10) / (1 + 4).
TEST(Scaling, IsOfLeastSquares) {
    EXPECT_DOUBLE_EQ(scale_of({3, 5}, {1, 2}), 2.6);
    EXPECT_DOUBLE_EQ(scale_of({4, 8}, {1, 2}), 4.0);
}

TEST(Scaling, MarkedAndNotFiniteSamplesHaveNoSay) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    EXPECT_DOUBLE_EQ(scale_of({3, 100, kNaN, 5}, {1, 1, 7, 2}, {0, 2, 0, 0}), 2.6);
    EXPECT_EQ(scale_of({1, 2}, {0, 0}), 0.0) << "nothing can tell";
}

// Noise in the image, were it regressed the other way, would lower the factor by 1 / (1 + 1).
TEST(Scaling, NoiseOfTheImageLeavesItRight) {
    constexpr double kFactor = 3.0;
    constexpr std::size_t kSamples = 40000;
    constexpr double kFourSigma = 4.0 * kFactor / 200.0;  // sigma = noise / sqrt(samples) / 1
    std::mt19937 random(4);
    std::normal_distribution<float> noise(0.0F, static_cast<float>(kFactor));
    Samples image;
    for (std::size_t i = 0; i < kSamples; ++i)
        image.push_back(static_cast<float>(kFactor) + noise(random));
    EXPECT_NEAR(scale_of(image, Samples(kSamples, 1.0F)), kFactor, kFourSigma);
}

}  // namespace
}  // namespace aphotic::scaling_test
