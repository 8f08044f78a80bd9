// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/cone_edge.h"

#include "image/image_size.h"
#include "light/dispersion.h"
#include "light/floor_ray.h"
#include "light/tile_cone.h"
#include "rig/geometry.h"

#include <algorithm>
#include <array>
#include <span>

namespace aphotic {

namespace {

using Eigen::Vector3d;

constexpr int kTile_px = 32;

// An emitter's rim at its corners and halfway between them, and its middle; a point's own position.
std::vector<Vector3d> places_of(const Strobe& strobe) {
    if (!strobe.emitter) return {strobe.position_m};
    // The centres of a grid of three by three cells are two thirds of the way to the rim.
    constexpr double kToTheRim = 1.5;
    std::vector<Vector3d> places_m;
    for (const Vector3d& centre : lamp_positions_m(strobe, {.across = 3, .along = 3}))
        places_m.push_back(strobe.position_m + kToTheRim * (centre - strobe.position_m));
    return places_m;
}

std::vector<double> ends_nm(const Rig& rig) {
    if (!disperses(rig)) return {rig.camera.range.first_nm};
    return {rig.camera.range.first_nm, rig.camera.range.last_nm};
}

void take_in(const std::uint8_t* bits, std::size_t count, std::uint8_t* mask) {
    for (std::size_t i = 0; i < count; ++i) mask[i] = static_cast<std::uint8_t>(mask[i] | bits[i]);
}

}  // namespace

// Pixels of the image, and one more row and column, so that neighbours in two tiles are compared in
// one.
struct ConeEdges::Tile {
    int column;
    int row;
    int width;
    int height;
};

ConeEdges::ConeEdges(const Rig& rig) : rig_(rig), rays_(rig, ends_nm(rig), 1) {
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        beams_.emplace_back(rig.strobes[s]);
        for (std::size_t edge = 0; edge < beams_[s].count(); ++edge) {
            edges_.push_back({.places_m = places_of(rig.strobes[s]),
                              .strobe = s,
                              .edge = edge,
                              .creases = beams_[s].creases(edge)});
        }
    }
}

void ConeEdges::mark(const Tile& tile, const Sled& sled, std::vector<std::uint8_t>& mask) const {
    const Plane floor = floor_plane(sled);
    std::array<WaterRay, 2> found;
    const std::span<WaterRay> ends = std::span(found).first(disperses(rig_) ? 2 : 1);
    const auto look = [&](double x, double y) {
        rays_.look(tile.column + x + 0.5, tile.row + y + 0.5, ends);
    };
    std::vector<FloorRay> outline;
    for (const auto& [x, y] : tile_places(tile.width, tile.height)) {
        look(x, y);
        for (const WaterRay& end : ends) outline.push_back(floor_ray(end, floor));
    }
    const bool has_horizon = std::ranges::any_of(outline, &FloorRay::sees_floor) &&
                             !std::ranges::all_of(outline, &FloorRay::sees_floor);
    std::vector<const LampEdge*> near;
    for (const LampEdge& edge : edges_) {
        const bool is_near = std::ranges::any_of(edge.places_m, [&](const Vector3d& place_m) {
            const TileCone cone = tile_cone(place_m, outline);
            return cone.sees_any && std::ranges::any_of(edge.creases, [&](const Crease& crease) {
                       return !cone.sees_all || comes_into(cone, crease);
                   });
        });
        if (is_near) near.push_back(&edge);
    }
    if (!has_horizon && near.empty()) return;

    // By pixel, how many of the rays and places have its point within something with an edge: the
    // floor itself, then each of the edges.
    const std::size_t things = near.size() + 1;
    std::vector<std::size_t> counts(things * size_of(tile.width) * size_of(tile.height));
    const auto counts_of = [&](int x, int y) {
        return &counts[things * (size_of(y) * size_of(tile.width) + size_of(x))];
    };
    const auto mark_pixel = [&](int x, int y) {
        mask[size_of(tile.row + y) * size_of(rig_.camera.width_px) + size_of(tile.column + x)] = 1;
    };
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            std::size_t* const here = counts_of(x, y);
            look(x, y);
            for (const WaterRay& end : ends) {
                const FloorRay ray = floor_ray(end, floor);
                if (!ray.sees_floor()) continue;
                ++here[0];
                for (std::size_t k = 0; k < near.size(); ++k) {
                    for (const Vector3d& place_m : near[k]->places_m) {
                        here[k + 1] +=
                            beams_[near[k]->strobe].is_within(near[k]->edge, towards(place_m, ray))
                                ? 1
                                : 0;
                    }
                }
            }
            for (std::size_t k = 0; k < things; ++k) {
                const std::size_t most = ends.size() * (k == 0 ? 1 : near[k - 1]->places_m.size());
                if (here[k] > 0 && here[k] < most) mark_pixel(x, y);
                if (x > 0 && here[k] != counts_of(x - 1, y)[k])
                    mark_pixel(x, y), mark_pixel(x - 1, y);
                if (y > 0 && here[k] != counts_of(x, y - 1)[k])
                    mark_pixel(x, y), mark_pixel(x, y - 1);
            }
        }
    }
}

std::vector<std::uint8_t> ConeEdges::mask(const Sled& sled, int within_px) const {
    const int width = rig_.camera.width_px;
    const int height = rig_.camera.height_px;
    std::vector<std::uint8_t> mask(size_of(width) * size_of(height));
    if (within_px == 0) return mask;
    for (int row = 0; row < height; row += kTile_px) {
        for (int column = 0; column < width; column += kTile_px) {
            mark({.column = column,
                  .row = row,
                  .width = std::min(kTile_px + 1, width - column),
                  .height = std::min(kTile_px + 1, height - row)},
                 sled,
                 mask);
        }
    }
    spread(mask, width, within_px - 1);
    return mask;
}

void spread(std::vector<std::uint8_t>& mask, int width_px, int within_px) {
    const std::size_t width = size_of(width_px);
    std::vector<std::uint8_t> before(within_px > 0 ? mask.size() : 0);
    for (int step = 0; step < within_px; ++step) {
        before = mask;
        take_in(before.data(), mask.size() - width, mask.data() + width);
        take_in(before.data() + width, mask.size() - width, mask.data());
        before = mask;
        // By pointers, since in rows of one pixel the last has nothing to its right.
        for (std::size_t start = 0; start < mask.size(); start += width) {
            const std::uint8_t* const from = before.data() + start;
            std::uint8_t* const to = mask.data() + start;
            take_in(from, width - 1, to + 1);
            take_in(from + 1, width - 1, to);
        }
    }
}

}  // namespace aphotic
