// SPDX-License-Identifier: BSD-3-Clause
//
// A smooth function over a tile of pixels, from a few of its places: the polynomial of degree
// kTilePoints - 1 each way through Chebyshev's points of the second kind, which run from the first
// pixel's centre to the last's, dense at both ends.
//
//   f(x, y) = sum_i sum_j l_i(x) l_j(y) f(x_i, y_j)
//
// Between them, at the places kTileChecks, the caller compares it with f itself. These are in the
// middles of gaps between points: in the four corners, and twice in every gap of either direction,
// so that no line along an axis slips past them.
//
// L. N. Trefethen, Approximation Theory and Approximation Practice, SIAM 2013, chapters 2 and 5.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace aphotic {

inline constexpr int kTilePoints = 7;
inline constexpr int kTileGaps = kTilePoints - 1;
inline constexpr std::array<std::array<int, 2>, std::size_t{2} * kTileGaps> kTileChecks{{{0, 0},
                                                                                         {5, 5},
                                                                                         {0, 5},
                                                                                         {5, 0},
                                                                                         {1, 3},
                                                                                         {2, 1},
                                                                                         {3, 4},
                                                                                         {4, 2},
                                                                                         {1, 2},
                                                                                         {2, 4},
                                                                                         {3, 1},
                                                                                         {4, 3}}};
inline constexpr int kTilePixels = 256;  // along a side, at most

using TileNodes = Eigen::Matrix<double, kTilePoints, kTilePoints>;  // (row, column)

// From -1 to 1, and l_i at x.
[[nodiscard]] double chebyshev_point(int i);
[[nodiscard]] std::array<double, kTilePoints> chebyshev_shares(double x);

// One side of a tile of this many pixels. Places are pixels from the first one's centre.
struct TileAxis {
    std::array<double, kTilePoints> points_px{};
    std::array<double, kTileGaps> gaps_px{};  // their middles
    Eigen::Matrix<float, Eigen::Dynamic, kTilePoints, Eigen::ColMajor, kTilePixels> to_pixels;
    Eigen::Matrix<double, kTileGaps, kTilePoints> to_gaps;
};
[[nodiscard]] const TileAxis& tile_axis(int pixels);  // 1 to kTilePixels

// For f = sum_i sum_j a_ij T_i(x) T_j(y), in Chebyshev's polynomials: the size of the last degree's
// terms plus a quarter of the last but one's, either way. For a smooth f that is the polynomial's
// error, or more; a step or a kink between any two places shows in it, wherever it is.
[[nodiscard]] double last_degrees(const TileNodes& nodes);

}  // namespace aphotic
