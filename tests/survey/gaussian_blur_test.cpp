// SPDX-License-Identifier: BSD-3-Clause
#include "survey/gaussian_blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace aphotic::gaussian_blur_test {
namespace {

constexpr double kFloat = 1e-6;  // a few roundings of a float, relative

TEST(GaussianBlur, LeavesAConstant) {
    for (const double sigma_px : {0.3, 2.0, 17.5, 400.0}) {
        for (const float sample : gaussian_blur(std::vector<float>(30 * 20, 0.7F), 30, sigma_px))
            ASSERT_NEAR(sample, 0.7, 0.7 * kFloat) << sigma_px;
    }
}

// Mirrored borders send back what would leave.
TEST(GaussianBlur, KeepsTheMean) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform;
    std::vector<float> plane(31 * 17);
    for (float& sample : plane) sample = uniform(random);
    const double mean = std::accumulate(plane.begin(), plane.end(), 0.0);
    for (const double sigma_px : {0.5, 4.0, 50.0}) {
        const std::vector<float> smooth = gaussian_blur(plane, 31, sigma_px);
        EXPECT_NEAR(std::accumulate(smooth.begin(), smooth.end(), 0.0), mean, mean * kFloat);
    }
}

// A point becomes the bell of that variance, the same each way, within the stated bound.
TEST(GaussianBlur, SpreadsAPointToTheGaussian) {
    constexpr int kSide = 201;
    constexpr int kMiddle = 100;
    constexpr double kBound = 0.035;  // of the peak along one axis, as the header says
    constexpr double kOfTwo = 2.0 * kBound + kBound * kBound;
    for (const double sigma_px : {2.0, 7.3, 15.0}) {
        std::vector<float> plane(kSide * kSide, 0.0F);
        plane[kMiddle * kSide + kMiddle] = 1.0F;
        const std::vector<float> bell = gaussian_blur(plane, kSide, sigma_px);
        const double peak = 1.0 / (2.0 * std::numbers::pi * sigma_px * sigma_px);
        double variance_x = 0.0;
        double variance_y = 0.0;
        for (int row = 0; row < kSide; ++row) {
            for (int column = 0; column < kSide; ++column) {
                const double x = column - kMiddle;
                const double y = row - kMiddle;
                const double found = bell[static_cast<std::size_t>(row * kSide + column)];
                const double wanted =
                    peak * std::exp(-(x * x + y * y) / (2.0 * sigma_px * sigma_px));
                ASSERT_NEAR(found, wanted, kOfTwo * peak) << x << ", " << y;
                variance_x += found * x * x;
                variance_y += found * y * y;
            }
        }
        EXPECT_NEAR(variance_x / (sigma_px * sigma_px), 1.0, 1e-4) << "floats far out add up";
        EXPECT_NEAR(variance_y / (sigma_px * sigma_px), 1.0, 1e-4);
    }
}

}  // namespace
}  // namespace aphotic::gaussian_blur_test
