// SPDX-License-Identifier: BSD-3-Clause
#include "light/tile_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::tile_fit_test {
namespace {

// Interpolation is exact for polynomials of its degree: what is left is rounding, of floats where
// pixels are concerned, enlarged by Lebesgue's constant, under 2.5 of seven such points.
constexpr double kFloats = 2.5 * kTilePoints * 0x1p-24;
constexpr double kDoubles = 2.5 * kTilePoints * 0x1p-53;

double polynomial(double x, int pixels) {
    const double t = pixels > 1 ? x / (pixels - 1) : 0.0;
    return 0.3 + t * (1.0 - t * (2.0 - t * (0.5 - t * (1.5 + t * (0.25 - t)))));
}

TEST(TileFit, IsExactForPolynomialsOfItsDegree) {
    for (const int pixels : {1, 2, 7, 9, 33, kTilePixels}) {
        const TileAxis& axis = tile_axis(pixels);
        Eigen::Matrix<double, kTilePoints, 1> values;
        for (int i = 0; i < kTilePoints; ++i)
            values(i) = polynomial(axis.points_px[static_cast<std::size_t>(i)], pixels);
        const Eigen::VectorXf at_pixels = axis.to_pixels * values.cast<float>();
        ASSERT_EQ(at_pixels.size(), pixels);
        for (int pixel = 0; pixel < pixels; ++pixel)
            EXPECT_NEAR(at_pixels(pixel), polynomial(pixel, pixels), kFloats) << pixels;
        const auto at_checks = (axis.to_checks * values).eval();
        for (int k = 0; k < kTileChecks; ++k) {
            const double x = axis.checks_px[static_cast<std::size_t>(k)];
            EXPECT_NEAR(at_checks(k), polynomial(x, pixels), kDoubles) << pixels;
        }
    }
}

TEST(TileFit, ReachesFromTheFirstPixelToTheLast) {
    for (const int pixels : {1, 8, kTilePixels}) {
        EXPECT_EQ(tile_axis(pixels).points_px.front(), 0.0);
        EXPECT_NEAR(tile_axis(pixels).points_px.back(), pixels - 1, pixels * 0x1p-52);
    }
}

}  // namespace
}  // namespace aphotic::tile_fit_test
