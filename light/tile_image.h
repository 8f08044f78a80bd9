// SPDX-License-Identifier: BSD-3-Clause
//
// Light at every pixel of an image, at a cost that depends on how much of it is not smooth.
//
// The image is divided into square tiles. The parts of a tile's light that may be smooth are
// computed at the points of tile_fit.h and interpolated, if they are accurate at the places
// between. The rest is passed to the tile's four quarters, and at kDirectPixels is computed pixel
// by pixel. Tiles depend only on the image, and are painted whole: neither threads nor the
// requested rows change a bit.
//
// Users of this (floor_image.cpp, veil_map.cpp) supply a class, one object per thread, with
//
//   Piece, Group    a part of the light that may be smooth in one tile and not in another; parts
//                   that are interpolated together
//   Place, Found    what all pieces share at a place; a group's light there, `signals`
//   kLanes          places computed at a time
//   planes()        of the image
//   split(tile, pieces, rest)       groups that may be smooth in a tile; adds the others to rest
//   all_of(pieces)                  one group
//   give_back(group, rest)          adds a group that is not smooth to rest
//   place(at, is_exact)             of kLanes; is_exact: not points of polynomials
//   find(group, place, is_exact)    Found of all these
//   of_lane(found, k)               of one of them: `signals`, and whatever these functions need
//   is_within(found)                whether it may be interpolated
//   beside(place, signals)          adds light that is not in any of these pieces; for one lane
//   is_right(found, check)          whether a polynomial is accurate, at one place
//   settle(group, column, row, place, signals, found)   the final value of a pixel
#pragma once

#include "base/parallel.h"
#include "light/tile_fit.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr int kDirectPixels = 8;
inline constexpr std::size_t kTilePlanes = 12;  // at most
using PlaceSignals = std::array<double, kTilePlanes>;

struct Tile {
    int column = 0;
    int row = 0;
    int width = 0;
    int height = 0;

    [[nodiscard]] bool is_direct() const {
        return width <= kDirectPixels && height <= kDirectPixels;
    }
};
[[nodiscard]] std::array<Tile, 4> quarters(const Tile& tile);

// A place of an image: column and row, at pixels' corners.
using PixelPlace = std::array<double, 2>;

// A polynomial's value at a place between its points.
struct TileCheck {
    PlaceSignals interpolated{};
    PlaceSignals last_degrees{};  // tile_fit.h
    PlaceSignals signals{};       // the total there, as far as it is known
};

// Defaults of most members.
struct TileLight {
    static constexpr std::size_t kLanes = 1;
    static const auto& of_lane(const auto& found, std::size_t /*k*/) { return found; }
    static bool is_within(const auto& /*found*/) { return true; }
    static void beside(const auto& /*place*/, PlaceSignals& /*signals*/) {}
    static void settle(const auto&... /*all*/) {}
};

// Rows of an image that are whole tiles, planes one after another.
struct ImageRows {
    int width_px = 0;
    int height_px = 0;
    int first = 0;
    int count = 0;
    float* samples = nullptr;
};

// Row by row.
[[nodiscard]] std::vector<Tile> tiles_of(const ImageRows& rows, int tile_px);

using TilePlane = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using TilePlaneMap = Eigen::Map<TilePlane, Eigen::Unaligned, Eigen::OuterStride<>>;
// A tile of an image's plane, set to 0.
[[nodiscard]] TilePlaneMap plane_in(const ImageRows& rows, std::size_t plane, const Tile& tile);

// A tile of the image's grid, and its pixels' sums so far.
template <class Light>
class TilePainter {
  public:
    using Pieces = std::vector<typename Light::Piece>;

    TilePainter(Light& light, const Tile& whole, const ImageRows& rows)
        : light_(light), whole_(whole) {
        for (std::size_t c = 0; c < light.planes(); ++c)
            planes_.push_back(plane_in(rows, c, whole));
    }

    void paint(const Tile& tile, const Pieces& pieces) {
        if (pieces.empty() || tile.width == 0 || tile.height == 0) return;
        if (tile.is_direct()) {
            paint_directly(tile, light_.all_of(pieces));
            return;
        }
        Pieces rest;
        std::vector<Polynomial> found;
        for (auto& group : light_.split(tile, pieces, rest))
            found.push_back({.group = std::move(group), .nodes = Nodes(planes_.size())});
        if (!found.empty()) interpolate(tile, found);
        for (const Polynomial& one : found)
            if (!one.is_right) light_.give_back(one.group, rest);
        for (const Tile& quarter : quarters(tile)) paint(quarter, rest);
    }

  private:
    using Nodes = std::vector<TileNodes>;
    struct Polynomial {
        typename Light::Group group;
        Nodes nodes;  // by plane
        bool is_right = true;
        PlaceSignals last_degrees{};
    };
    using Polynomials = std::vector<Polynomial>;

    static bool none_is_right(const Polynomials& all) {
        return std::ranges::none_of(all, &Polynomial::is_right);
    }

    static constexpr std::size_t kLanes = Light::kLanes;

    // Lanes of a tile's places from the first on, given by at(k) in pixels from the tile's first
    // centre; spare lanes repeat the last place.
    [[nodiscard]] typename Light::Place places_in(const Tile& tile,
                                                  std::size_t first,
                                                  std::size_t count,
                                                  const auto& at,
                                                  bool is_exact) const {
        std::array<PixelPlace, kLanes> places;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const auto [x, y] = at(std::min(first + lane, count - 1));
            places[lane] = {tile.column + x + 0.5, tile.row + y + 0.5};
        }
        return light_.place(places, is_exact);
    }

    [[nodiscard]] float& sample(std::size_t plane, const Tile& tile, int x, int y) {
        return planes_[plane](tile.row - whole_.row + y, tile.column - whole_.column + x);
    }

    // Row by row: rays of places in a row are found together (ray_table.h).
    void take_nodes(const Tile& tile, Polynomials& all) {
        constexpr std::size_t kNodes = std::size_t{kTilePoints} * kTilePoints;
        const TileAxis& across = tile_axis(tile.width);
        const TileAxis& down = tile_axis(tile.height);
        const auto at = [&](std::size_t k) {
            return PixelPlace{across.points_px[k % kTilePoints], down.points_px[k / kTilePoints]};
        };
        for (std::size_t k = 0, end = 0; k < kNodes && !none_is_right(all); k = end) {
            const std::size_t row_end = (k / kTilePoints + 1) * kTilePoints;
            const auto places = places_in(tile, k, row_end, at, false);
            end = std::min(k + kLanes, row_end);
            for (Polynomial& one : all) {
                const auto found = light_.find(one.group, places, false);
                for (std::size_t node = k; node < end; ++node) {
                    const auto& of_node = Light::of_lane(found, node - k);
                    one.is_right &= light_.is_within(of_node);
                    for (std::size_t c = 0; c < planes_.size(); ++c)
                        one.nodes[c](static_cast<Eigen::Index>(node / kTilePoints),
                                     static_cast<Eigen::Index>(node % kTilePoints)) =
                            of_node.signals[c];
                }
            }
        }
    }

    void check(const Tile& tile, std::size_t first, Polynomials& all) {
        const TileAxis& across = tile_axis(tile.width);
        const TileAxis& down = tile_axis(tile.height);
        const auto at = [&](std::size_t k) {
            const auto [i, j] = kTileChecks[k];
            return PixelPlace{across.gaps_px[static_cast<std::size_t>(i)],
                              down.gaps_px[static_cast<std::size_t>(j)]};
        };
        const auto places = places_in(tile, first, kTileChecks.size(), at, true);
        std::vector<typename Light::Found> found;
        for (const Polynomial& one : all) found.push_back(light_.find(one.group, places, true));
        for (std::size_t k = first; k < std::min(first + kLanes, kTileChecks.size()); ++k) {
            const auto [x, y] = at(k);
            PlaceSignals signals{};
            light_.beside(places, signals);
            for (std::size_t c = 0; c < planes_.size(); ++c) {
                signals[c] += static_cast<double>(sample(
                    c, tile, static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y))));
                for (const auto& one : found)
                    signals[c] += Light::of_lane(one, k - first).signals[c];
            }
            const auto [i, j] = kTileChecks[k];
            for (std::size_t one = 0; one < all.size(); ++one) {
                Polynomial& polynomial = all[one];
                TileCheck check{.interpolated = {},
                                .last_degrees = polynomial.last_degrees,
                                .signals = signals};
                for (std::size_t c = 0; c < planes_.size(); ++c)
                    check.interpolated[c] = down.to_gaps.row(j) * polynomial.nodes[c] *
                                            across.to_gaps.row(i).transpose();
                polynomial.is_right = polynomial.is_right &&
                                      light_.is_right(Light::of_lane(found[one], k - first), check);
            }
        }
    }

    void interpolate(const Tile& tile, Polynomials& all) {
        take_nodes(tile, all);
        for (Polynomial& one : all) {
            for (std::size_t c = 0; c < planes_.size(); ++c)
                one.last_degrees[c] = last_degrees(one.nodes[c]);
        }
        for (std::size_t k = 0; k < kTileChecks.size() && !none_is_right(all); k += kLanes)
            check(tile, k, all);
        if (none_is_right(all)) return;
        for (std::size_t c = 0; c < planes_.size(); ++c) {
            TileNodes sum = TileNodes::Zero();
            for (const Polynomial& one : all)
                if (one.is_right) sum += one.nodes[c];
            using NodeRows = Eigen::Matrix<float,
                                           kTilePoints,
                                           Eigen::Dynamic,
                                           Eigen::RowMajor,
                                           kTilePoints,
                                           kTilePixels>;
            const NodeRows rows =
                sum.cast<float>().lazyProduct(tile_axis(tile.width).to_pixels.transpose());
            planes_[c]
                .block(tile.row - whole_.row, tile.column - whole_.column, tile.height, tile.width)
                .noalias() += tile_axis(tile.height).to_pixels.lazyProduct(rows);
        }
    }

    void paint_directly(const Tile& tile, const typename Light::Group& all) {
        const auto width = static_cast<std::size_t>(tile.width);
        for (int y = 0; y < tile.height; ++y) {
            const auto at = [&](std::size_t x) {
                return PixelPlace{static_cast<double>(x), static_cast<double>(y)};
            };
            for (std::size_t left = 0; left < width; left += kLanes) {
                const auto places = places_in(tile, left, width, at, true);
                const auto found = light_.find(all, places, true);
                for (std::size_t x = left; x < std::min(left + kLanes, width); ++x)
                    settle(
                        tile, static_cast<int>(x), y, all, places, Light::of_lane(found, x - left));
            }
        }
    }

    void settle(const Tile& tile,
                int x,
                int y,
                const typename Light::Group& all,
                const typename Light::Place& places,
                auto found) {
        for (std::size_t c = 0; c < planes_.size(); ++c)
            so_far_[c] = static_cast<double>(sample(c, tile, x, y));
        light_.settle(all, tile.column + x + 0.5, tile.row + y + 0.5, places, so_far_, found);
        for (std::size_t c = 0; c < planes_.size(); ++c)
            sample(c, tile, x, y) = static_cast<float>(so_far_[c] + found.signals[c]);
    }

    Light& light_;
    Tile whole_;
    std::vector<TilePlaneMap> planes_;
    PlaceSignals so_far_{};  // of the current pixel: zeroing it for each takes as long
};

// All pieces, with a thread for each of these lights.
template <class Light>
void paint_tiles(std::vector<Light>& by_thread,
                 const std::vector<typename Light::Piece>& pieces,
                 int tile_px,
                 const ImageRows& rows) {
    const std::vector<Tile> tiles = tiles_of(rows, tile_px);
    parallel_for(tiles.size(), by_thread.size(), [&](std::size_t k, std::size_t thread) {
        TilePainter<Light>(by_thread[thread], tiles[k], rows).paint(tiles[k], pieces);
    });
}

}  // namespace aphotic
