// SPDX-License-Identifier: BSD-3-Clause
#include "light/floor_image.h"

#include "base/parallel.h"
#include "light/tile_cone.h"
#include "light/tile_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aphotic {
namespace {

using Eigen::Vector3d;

struct Tile {
    int column = 0;
    int row = 0;
    int width = 0;
    int height = 0;

    [[nodiscard]] bool is_direct() const {
        return width <= kDirectPixels && height <= kDirectPixels;
    }
};

// A lamp and a crease of it that comes into a tile; none: its light is too steep for the tile.
struct LampCrease {
    const FloorLamp* lamp = nullptr;
    const Crease* crease = nullptr;
};

// What one thread works on: a tile of the image's grid, and what its pixels have so far.
class Painter {
  public:
    Painter(const FloorLight& light, Tile whole) : light_(light), whole_(whole) {
        for (auto& plane : planes_) plane.setZero(whole.height, whole.width);
    }

    void paint(const Tile& tile, const std::vector<LampCrease>& lamps);

    [[nodiscard]] const Outside& outside() const { return outside_; }
    [[nodiscard]] const auto& planes() const { return planes_; }

  private:
    using Plane2 = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    using Lamps = std::vector<const FloorLamp*>;

    [[nodiscard]] PlaceRays rays_in(const Tile& tile, double x, double y, bool looks) const {
        return light_.rays_at(tile.column + x + 0.5, tile.row + y + 0.5, looks);
    }
    [[nodiscard]] PlaceLight light_of(const Lamps& lamps, const PlaceRays& rays, bool looks) const;
    void note(const PlaceLight& light) {
        outside_.is_before |= light.is_before;
        outside_.is_beyond |= light.is_beyond;
    }
    [[nodiscard]] bool interpolate(const Tile& tile, const Lamps& lamps);
    void paint_directly(const Tile& tile, const Lamps& lamps);

    const FloorLight& light_;
    Tile whole_;
    std::array<Plane2, kChannels> planes_;
    Outside outside_;
};

PlaceLight Painter::light_of(const Lamps& lamps, const PlaceRays& rays, bool looks) const {
    PlaceLight light;
    for (const FloorLamp* lamp : lamps) light_.add(*lamp, rays, looks, light);
    return light;
}

bool is_in_doubt(const PlaceLight& light, const Signals& signals) {
    bool is = light.crosses;
    for (std::size_t c = 0; c < kChannels; ++c) is |= light.doubts[c] > kMostDoubt * signals[c];
    return is;
}

bool Painter::interpolate(const Tile& tile, const Lamps& lamps) {
    const TileAxis& across = tile_axis(tile.width);
    const TileAxis& down = tile_axis(tile.height);
    std::array<TileNodes, kChannels> nodes;
    for (int j = 0; j < kTilePoints; ++j) {
        for (int i = 0; i < kTilePoints; ++i) {
            const PlaceRays rays = rays_in(tile,
                                           across.points_px[static_cast<std::size_t>(i)],
                                           down.points_px[static_cast<std::size_t>(j)],
                                           false);
            const PlaceLight light = light_of(lamps, rays, false);
            if (light.is_before || light.is_beyond) return false;
            for (std::size_t c = 0; c < kChannels; ++c) nodes[c](j, i) = light.signals[c];
        }
    }
    for (int j = 0; j < kTileChecks; ++j) {
        for (int i = 0; i < kTileChecks; ++i) {
            const PlaceRays rays = rays_in(tile,
                                           across.checks_px[static_cast<std::size_t>(i)],
                                           down.checks_px[static_cast<std::size_t>(j)],
                                           true);
            const PlaceLight light = light_of(lamps, rays, light_.has_port());
            if (is_in_doubt(light, light.signals)) return false;
            for (std::size_t c = 0; c < kChannels; ++c) {
                const double told =
                    down.to_checks.row(j) * nodes[c] * across.to_checks.row(i).transpose();
                if (!(std::abs(told - light.signals[c]) <= kTileError / 3.0 * light.signals[c]))
                    return false;
            }
        }
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        const Eigen::Matrix<float, kTilePoints, Eigen::Dynamic> rows =
            nodes[c].cast<float>() * across.to_pixels.transpose();
        planes_[c]
            .block(tile.row - whole_.row, tile.column - whole_.column, tile.height, tile.width)
            .noalias() += down.to_pixels * rows;
    }
    return true;
}

void Painter::paint_directly(const Tile& tile, const Lamps& lamps) {
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const PlaceRays rays = rays_in(tile, x, y, true);
            const PlaceLight light = light_of(lamps, rays, light_.has_port());
            note(light);
            std::array<float*, kChannels> to{};
            Signals all = light.signals;
            for (std::size_t c = 0; c < kChannels; ++c) {
                to[c] = &planes_[c](tile.row - whole_.row + y, tile.column - whole_.column + x);
                all[c] += static_cast<double>(*to[c]);
            }
            Signals signals = light.signals;
            if (is_in_doubt(light, all))
                signals = light_.dispersed(lamps, tile.column + x + 0.5, tile.row + y + 0.5, rays);
            for (std::size_t c = 0; c < kChannels; ++c)
                *to[c] = static_cast<float>(static_cast<double>(*to[c]) + signals[c]);
        }
    }
}

// The rays of a tile's places at all nodes, the middle one first.
std::vector<FloorRay> rays_of(const FloorLight& light, const Tile& tile) {
    std::vector<FloorRay> rays;
    for (const auto& [x, y] : tile_places(tile.width, tile.height)) {
        const PlaceRays all = light.rays_at(tile.column + x + 0.5, tile.row + y + 0.5, false);
        rays.insert(rays.end(), all.begin(), all.begin() + (light.has_port() ? kIndexNodes : 1));
    }
    return rays;
}

std::array<Tile, 4> quarters(const Tile& tile) {
    const int left = (tile.width + 1) / 2;
    const int top = (tile.height + 1) / 2;
    return {{{tile.column, tile.row, left, top},
             {tile.column + left, tile.row, tile.width - left, top},
             {tile.column, tile.row + top, left, tile.height - top},
             {tile.column + left, tile.row + top, tile.width - left, tile.height - top}}};
}

void Painter::paint(const Tile& tile, const std::vector<LampCrease>& lamps) {
    if (lamps.empty() || tile.width == 0 || tile.height == 0) return;
    Lamps smooth;
    std::vector<LampCrease> rest;
    if (tile.is_direct()) {
        for (const LampCrease& one : lamps)
            if (smooth.empty() || smooth.back() != one.lamp) smooth.push_back(one.lamp);
        paint_directly(tile, smooth);
        return;
    }
    const std::vector<FloorRay> rays = rays_of(light_, tile);
    for (std::size_t k = 0; k < lamps.size();) {
        const FloorLamp* const lamp = lamps[k].lamp;
        const TileCone cone = tile_cone(lamp->position_m, rays);
        const std::size_t before = rest.size();
        if (cone.sees_any && !cone.sees_all) rest.push_back({.lamp = lamp});
        for (; k < lamps.size() && lamps[k].lamp == lamp; ++k) {
            const bool is_near = lamps[k].crease != nullptr && cone.sees_any &&
                                 (!cone.sees_all || comes_into(cone, *lamps[k].crease));
            if (is_near) rest.push_back(lamps[k]);
        }
        if (cone.sees_all && rest.size() == before) smooth.push_back(lamp);
    }
    if (!smooth.empty() && !interpolate(tile, smooth)) {
        for (const FloorLamp* lamp : smooth) rest.push_back({.lamp = lamp});
    }
    for (const Tile& quarter : quarters(tile)) paint(quarter, rest);
}

}  // namespace

Outside paint_floor(const FloorLight& light, int height_px, int threads, const ImageRows& rows) {
    std::vector<LampCrease> lamps;
    for (const FloorLamp& lamp : light.lamps()) {
        lamps.push_back({.lamp = &lamp});
        for (const Crease& crease : light.creases(lamp))
            lamps.push_back({.lamp = &lamp, .crease = &crease});
    }
    const int across = (rows.width_px + kTilePixels - 1) / kTilePixels;
    const int first = rows.first / kTilePixels;
    const int down = (rows.first + rows.count - 1) / kTilePixels - first + 1;
    std::vector<Outside> outside(static_cast<std::size_t>(threads));
    const auto width = static_cast<std::size_t>(rows.width_px);
    const std::size_t plane_size = width * static_cast<std::size_t>(rows.count);
    parallel_for(static_cast<std::size_t>(across) * static_cast<std::size_t>(down),
                 static_cast<std::size_t>(threads),
                 [&](std::size_t index, std::size_t thread) {
                     const int k = static_cast<int>(index);
                     Tile tile{.column = k % across * kTilePixels,
                               .row = (first + k / across) * kTilePixels};
                     tile.width = std::min(kTilePixels, rows.width_px - tile.column);
                     tile.height = std::min(kTilePixels, height_px - tile.row);
                     Painter painter(light, tile);
                     painter.paint(tile, lamps);
                     outside[thread].is_before |= painter.outside().is_before;
                     outside[thread].is_beyond |= painter.outside().is_beyond;
                     const int top = std::max(tile.row, rows.first);
                     const int end = std::min(tile.row + tile.height, rows.first + rows.count);
                     for (std::size_t c = 0; c < kChannels; ++c) {
                         for (int row = top; row < end; ++row) {
                             const float* const from = &painter.planes()[c](row - tile.row, 0);
                             std::copy_n(from,
                                         tile.width,
                                         rows.samples + c * plane_size +
                                             static_cast<std::size_t>(row - rows.first) * width +
                                             static_cast<std::size_t>(tile.column));
                         }
                     }
                 });
    Outside all;
    for (const Outside& one : outside) {
        all.is_before |= one.is_before;
        all.is_beyond |= one.is_beyond;
    }
    return all;
}

}  // namespace aphotic
