// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/floor_texture.h"

#include "support/dice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::floor_texture_test {
namespace {

constexpr double kContrast = 0.3;

// Of log T at one place over many seeds: a corner of the grids' cells is as uneven as their middle.
TEST(FloorTexture, HasItsContrastAtEveryPlace) {
    constexpr int kSeeds = 20'000;
    const double variance = std::log1p(kContrast * kContrast);
    for (const double x_m : {-0.2368, 0.0, 1.7}) {
        double mean = 0.0;
        double sum = 0.0;
        double squares = 0.0;
        for (int seed = 1; seed <= kSeeds; ++seed) {
            const double t =
                FloorTexture(kContrast, static_cast<std::uint64_t>(seed)).at(x_m, 0.31);
            ASSERT_GT(t, 0.0);
            mean += t / kSeeds;
            sum += std::log(t) / kSeeds;
            squares += std::log(t) * std::log(t) / kSeeds;
        }
        // Four standard deviations of each estimate.
        EXPECT_NEAR(mean, 1.0, 4.0 * kContrast / std::sqrt(kSeeds));
        EXPECT_NEAR(squares - sum * sum, variance, 4.0 * variance * std::sqrt(2.0 / kSeeds));
    }
}

TEST(FloorTexture, IsAsSmoothAsItsFinestGrid) {
    const FloorTexture texture(kContrast, 5);
    Dice dice(1);
    for (int i = 0; i < 1000; ++i) {
        const double x_m = dice.between(-3.0, 3.0);
        const double y_m = dice.between(-3.0, 3.0);
        // A blend is steepest in the middle of a cell, 15/8 of a straight line; between corners
        // that differ by at most 4 sqrt(3), of six octaves, whose weights' root sum of squares is
        // at least sqrt(6)/2: over 1e-6 m under 1e-3.
        constexpr double kStep_m = 1e-6;
        EXPECT_NEAR(
            texture.at(x_m + kStep_m, y_m), texture.at(x_m, y_m), 1e-3 * texture.at(x_m, y_m));
    }
}

TEST(FloorTexture, IsOneFloorForASeed) {
    EXPECT_EQ(FloorTexture(kContrast, 5).at(1.0, 2.0), FloorTexture(kContrast, 5).at(1.0, 2.0));
    EXPECT_NE(FloorTexture(kContrast, 5).at(1.0, 2.0), FloorTexture(kContrast, 6).at(1.0, 2.0));
    EXPECT_EQ(FloorTexture(0.0, 5).at(1.0, 2.0), 1.0);
}

}  // namespace
}  // namespace aphotic::floor_texture_test
