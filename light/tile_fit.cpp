// SPDX-License-Identifier: BSD-3-Clause
#include "light/tile_fit.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace aphotic {
namespace {

constexpr int kLast = kTilePoints - 1;

}  // namespace

double chebyshev_point(int i) {
    static const auto kPoints = [] {
        std::array<double, kTilePoints> points{};
        for (int k = 0; k <= kLast; ++k)
            points[static_cast<std::size_t>(k)] = -std::cos(std::numbers::pi * k / kLast);
        return points;
    }();
    return kPoints[static_cast<std::size_t>(i)];
}

// By the barycentric formula.
std::array<double, kTilePoints> chebyshev_shares(double x) {
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

namespace {

TileAxis axis_of(int pixels) {
    TileAxis axis;
    const double half_px = 0.5 * (pixels - 1);
    for (int i = 0; i < kTilePoints; ++i)
        axis.points_px[static_cast<std::size_t>(i)] = half_px * (1.0 + chebyshev_point(i));
    for (int gap = 0; gap < kTileGaps; ++gap) {
        const double x = 0.5 * (chebyshev_point(gap) + chebyshev_point(gap + 1));
        axis.gaps_px[static_cast<std::size_t>(gap)] = half_px * (1.0 + x);
        const auto shares = chebyshev_shares(x);
        for (int i = 0; i < kTilePoints; ++i)
            axis.to_gaps(gap, i) = shares[static_cast<std::size_t>(i)];
    }
    axis.to_pixels.resize(pixels, kTilePoints);
    for (int pixel = 0; pixel < pixels; ++pixel) {
        const auto shares = chebyshev_shares(pixels > 1 ? pixel / half_px - 1.0 : 0.0);
        for (int i = 0; i < kTilePoints; ++i)
            axis.to_pixels(pixel, i) = static_cast<float>(shares[static_cast<std::size_t>(i)]);
    }
    return axis;
}

// a = C f in one direction.
TileNodes to_degrees() {
    TileNodes C;
    for (int k = 0; k <= kLast; ++k) {
        for (int i = 0; i <= kLast; ++i) {
            const double half = (i % kLast == 0 ? 0.5 : 1.0) * (k % kLast == 0 ? 0.5 : 1.0);
            C(k, i) = 2.0 / kLast * half * std::cos(std::numbers::pi * k * (kLast - i) / kLast);
        }
    }
    return C;
}

}  // namespace

double last_degrees(const TileNodes& nodes) {
    static const TileNodes kToDegrees = to_degrees();
    const TileNodes a = (kToDegrees * nodes * kToDegrees.transpose()).cwiseAbs();
    const double last = a.row(kLast).sum() + a.col(kLast).head<kLast>().sum();
    const double before =
        a.row(kLast - 1).head<kLast>().sum() + a.col(kLast - 1).head<kLast - 1>().sum();
    return last + 0.25 * before;
}

const TileAxis& tile_axis(int pixels) {
    static const std::vector<TileAxis> kAxes = [] {
        std::vector<TileAxis> made;
        made.reserve(kTilePixels);
        for (int count = 1; count <= kTilePixels; ++count) made.push_back(axis_of(count));
        return made;
    }();
    return kAxes[static_cast<std::size_t>(pixels - 1)];
}

}  // namespace aphotic
