// SPDX-License-Identifier: BSD-3-Clause
#include "light/tile_fit.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace aphotic {
namespace {

constexpr int kLast = kTilePoints - 1;

double chebyshev_point(int i) {
    return -std::cos(std::numbers::pi * i / kLast);
}

// l_i at x, by the barycentric formula.
std::array<double, kTilePoints> lagrange_at(double x) {
    std::array<double, kTilePoints> shares{};
    double sum = 0.0;
    for (int i = 0; i <= kLast; ++i) {
        const double away = x - chebyshev_point(i);
        const auto k = static_cast<std::size_t>(i);
        if (away == 0.0) {
            shares.fill(0.0);
            shares[k] = 1.0;
            return shares;
        }
        const double half = i == 0 || i == kLast ? 0.5 : 1.0;
        shares[k] = (i % 2 == 0 ? half : -half) / away;
        sum += shares[k];
    }
    for (double& share : shares) share /= sum;
    return shares;
}

TileAxis axis_of(int pixels) {
    TileAxis axis;
    const double half_px = 0.5 * (pixels - 1);
    for (int i = 0; i < kTilePoints; ++i)
        axis.points_px[static_cast<std::size_t>(i)] = half_px * (1.0 + chebyshev_point(i));
    // In the middle of the first gap, of the last, and of one beside the middle.
    constexpr std::array<int, kTileChecks> kGaps{0, 3, 5};
    for (int k = 0; k < kTileChecks; ++k) {
        const int gap = kGaps[static_cast<std::size_t>(k)];
        const double x = 0.5 * (chebyshev_point(gap) + chebyshev_point(gap + 1));
        axis.checks_px[static_cast<std::size_t>(k)] = half_px * (1.0 + x);
        const auto shares = lagrange_at(x);
        for (int i = 0; i < kTilePoints; ++i)
            axis.to_checks(k, i) = shares[static_cast<std::size_t>(i)];
    }
    axis.to_pixels.resize(pixels, kTilePoints);
    for (int pixel = 0; pixel < pixels; ++pixel) {
        const auto shares = lagrange_at(pixels > 1 ? pixel / half_px - 1.0 : 0.0);
        for (int i = 0; i < kTilePoints; ++i)
            axis.to_pixels(pixel, i) = static_cast<float>(shares[static_cast<std::size_t>(i)]);
    }
    return axis;
}

}  // namespace

const TileAxis& tile_axis(int pixels) {
    static const std::vector<TileAxis> kAxes = [] {
        std::vector<TileAxis> made;
        for (int count = 1; count <= kTilePixels; ++count) made.push_back(axis_of(count));
        return made;
    }();
    return kAxes[static_cast<std::size_t>(pixels - 1)];
}

}  // namespace aphotic
