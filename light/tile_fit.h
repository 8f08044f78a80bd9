// SPDX-License-Identifier: BSD-3-Clause
//
// What is smooth over a tile of pixels, from a few places of it: the polynomial of degree
// kTilePoints - 1 each way through Chebyshev's points of the second kind, which lie from the first
// pixel's centre to the last's, close together at both ends.
//
//   f(x, y) = sum_i sum_j l_i(x) l_j(y) f(x_i, y_j)
//
// Between these, at kTileChecks places each way, who asks compares it with f itself.
//
// L. N. Trefethen, Approximation Theory and Approximation Practice, SIAM 2013, chapters 2 and 5.
#pragma once

#include <Eigen/Core>

#include <array>

namespace aphotic {

inline constexpr int kTilePoints = 7;
inline constexpr int kTileChecks = 3;
inline constexpr int kTilePixels = 64;  // along a side, at most

using TileNodes = Eigen::Matrix<double, kTilePoints, kTilePoints>;  // (row, column)

// One way across a tile of so many pixels. Places are pixels from the first one's centre.
struct TileAxis {
    std::array<double, kTilePoints> points_px{};
    std::array<double, kTileChecks> checks_px{};
    Eigen::Matrix<float, Eigen::Dynamic, kTilePoints, Eigen::ColMajor, kTilePixels> to_pixels;
    Eigen::Matrix<double, kTileChecks, kTilePoints> to_checks;
};
[[nodiscard]] const TileAxis& tile_axis(int pixels);  // 1 to kTilePixels

}  // namespace aphotic
