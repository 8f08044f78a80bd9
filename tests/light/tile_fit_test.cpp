// SPDX-License-Identifier: BSD-3-Clause
#include "light/tile_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

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
        const auto in_gaps = (axis.to_gaps * values).eval();
        for (int k = 0; k < kTileGaps; ++k) {
            const double x = axis.gaps_px[static_cast<std::size_t>(k)];
            EXPECT_NEAR(in_gaps(k), polynomial(x, pixels), kDoubles) << pixels;
        }
    }
}

TEST(TileFit, ReachesFromTheFirstPixelToTheLast) {
    for (const int pixels : {1, 8, kTilePixels}) {
        EXPECT_EQ(tile_axis(pixels).points_px.front(), 0.0);
        EXPECT_NEAR(tile_axis(pixels).points_px.back(), pixels - 1, pixels * 0x1p-52);
    }
}

TileNodes nodes_of(const std::function<double(double x, double y)>& f) {
    const TileAxis& axis = tile_axis(kTilePixels);
    TileNodes nodes;
    for (int j = 0; j < kTilePoints; ++j) {
        for (int i = 0; i < kTilePoints; ++i) {
            const auto place = [&](int k) {
                return 2.0 * axis.points_px[static_cast<std::size_t>(k)] / (kTilePixels - 1) - 1.0;
            };
            nodes(j, i) = f(place(i), place(j));
        }
    }
    return nodes;
}

// T_n(cos t) = cos(n t).
TEST(TileFit, TellsTheLastDegreesByTheirShares) {
    const auto T = [](int n, double x) {
        return std::cos(n * std::acos(std::clamp(x, -1.0, 1.0)));
    };
    constexpr double kNear = 1e-13;
    for (int n = 0; n <= 6; ++n) {
        const double expected = n == 6 ? 1.0 : n == 5 ? 0.25 : 0.0;
        EXPECT_NEAR(
            last_degrees(nodes_of([&](double x, double) { return T(n, x); })), expected, kNear);
        EXPECT_NEAR(last_degrees(nodes_of([&](double x, double y) { return T(n, y) * T(2, x); })),
                    expected,
                    kNear);
    }
}

// A step across the tile anywhere shows, of which a polynomial is off by about a half.
TEST(TileFit, TellsAStepWhereverItIs) {
    for (double at = -0.95; at < 0.96; at += 0.01) {
        const double seen =
            last_degrees(nodes_of([&](double x, double) { return x > at ? 1.0 : 0.0; }));
        EXPECT_GT(seen, 0.04) << at;
    }
}

TEST(TileFit, ChecksEveryGapOfEitherWayTwice) {
    std::array<int, kTileGaps> across{};
    std::array<int, kTileGaps> down{};
    for (const auto& [i, j] : kTileChecks) {
        ++across.at(static_cast<std::size_t>(i));
        ++down.at(static_cast<std::size_t>(j));
    }
    for (const int times : across) EXPECT_EQ(times, 2);
    for (const int times : down) EXPECT_EQ(times, 2);
}

}  // namespace
}  // namespace aphotic::tile_fit_test
