// SPDX-License-Identifier: BSD-3-Clause
#include "light/relief_image.h"

#include "base/parallel.h"
#include "light/relief_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace aphotic {
namespace {

// Pixels from the first up to the next vertices.
struct Cell {
    int column;
    int row;
    int right;
    int below;
};

std::array<std::size_t, 4> corners_of(const Cell& cell, const Relief& relief) {
    return {relief.at(cell.column, cell.row),
            relief.at(cell.right, cell.row),
            relief.at(cell.column, cell.below),
            relief.at(cell.right, cell.below)};
}

template <typename Work>
void for_each_pixel(const Cell& cell, const Relief& relief, const Work& work) {
    const int last_row = cell.below == relief.height_px - 1 ? cell.below : cell.below - 1;
    const int last_column = cell.right == relief.width_px - 1 ? cell.right : cell.right - 1;
    for (int row = cell.row; row <= last_row; ++row)
        for (int column = cell.column; column <= last_column; ++column) work(column, row);
}

// Calls look(column, row) at every vertex, then fill(cell), which leaves the vertices as they are.
template <typename Look, typename Fill>
void by_cells(const Relief& relief, int step_px, int threads, const Look& look, const Fill& fill) {
    const std::vector<int> columns = every(step_px, relief.width_px);
    const std::vector<int> rows = every(step_px, relief.height_px);
    const auto each = [&](std::size_t count, const auto& work) {
        parallel_for(
            count, static_cast<std::size_t>(threads), [&](std::size_t j, std::size_t) { work(j); });
    };
    each(rows.size(), [&](std::size_t j) {
        for (const int column : columns) look(column, rows[j]);
    });
    each(rows.size() - 1, [&](std::size_t j) {
        for (std::size_t i = 0; i + 1 < columns.size(); ++i)
            fill(Cell{.column = columns[i],
                      .row = rows[j],
                      .right = columns[i + 1],
                      .below = rows[j + 1]});
    });
}

// For one lamp, by pixel: 0 where it is visible. Between vertices of the mesh the value is shared
// if all four corners of a cell agree.
std::vector<std::uint8_t> shadow_of(const ReliefShadow& shadow,
                                    const Relief& relief,
                                    const Eigen::Vector3d& lamp_m,
                                    int threads) {
    std::vector<std::uint8_t> hidden(relief.point_m.size());
    const auto look = [&](int column, int row) {
        const std::size_t pixel = relief.at(column, row);
        hidden[pixel] = relief.knows(pixel) && shadow.hides(pixel, lamp_m) ? 1 : 0;
    };
    by_cells(relief, shadow.step_px(), threads, look, [&](const Cell& cell) {
        const std::array<std::size_t, 4> at = corners_of(cell, relief);
        const bool is_even =
            std::ranges::all_of(at, [&](std::size_t k) { return hidden[k] == hidden[at[0]]; });
        for_each_pixel(cell, relief, [&](int column, int row) {
            const std::size_t pixel = relief.at(column, row);
            if (std::ranges::find(at, pixel) != at.end()) return;
            if (is_even)
                hidden[pixel] = hidden[at[0]];
            else
                look(column, row);
        });
    });
    return hidden;
}

struct LampOnRelief {
    FloorLamp lamp;
    std::vector<std::uint8_t> hidden;
    const BeamEdges* edges;
    std::uint32_t of_shadow;
    std::vector<std::uint32_t> of_edges;
};

class ReliefPainter {
  public:
    ReliefPainter(const FloorLight& light, const Relief& relief, std::vector<LampOnRelief> lamps)
        : light_(light), relief_(relief), lamps_(std::move(lamps)) {
        found_.samples.resize(kChannels * relief.point_m.size());
        found_.seen.resize(relief.point_m.size());
    }

    void look(int column, int row);
    void fill(const Cell& cell);
    [[nodiscard]] ReliefLight take() { return std::move(found_); }

  private:
    [[nodiscard]] float& sample(std::size_t channel, std::size_t pixel) {
        return found_.samples[channel * relief_.point_m.size() + pixel];
    }
    [[nodiscard]] bool is_smooth(const Cell& cell) const;
    const FloorLight& light_;
    const Relief& relief_;
    std::vector<LampOnRelief> lamps_;
    ReliefLight found_;
};

// The weights of the corners at a place of the cell.
std::array<float, 4> shares_at(const Cell& cell, int column, int row) {
    const float x = static_cast<float>(column - cell.column) /
                    static_cast<float>(std::max(1, cell.right - cell.column));
    const float y =
        static_cast<float>(row - cell.row) / static_cast<float>(std::max(1, cell.below - cell.row));
    return {(1.0F - x) * (1.0F - y), x * (1.0F - y), (1.0F - x) * y, x * y};
}

void ReliefPainter::look(int column, int row) {
    const std::size_t pixel = relief_.at(column, row);
    if (!relief_.knows(pixel)) return;
    const Plane plane = relief_.plane(pixel);
    PlaceRays rays;
    if (light_.has_port()) {
        rays = light_.rays_at(column + 0.5, row + 0.5, plane);
    } else {
        rays[0] = floor_ray(
            {.origin_m = Eigen::Vector3d::Zero(), .direction = plane.point_m.normalized()}, plane);
    }
    PlaceLight place;
    std::uint32_t seen = 0;
    for (LampOnRelief& one : lamps_) {
        FloorLamp lamp = one.lamp;
        lamp.floor_m = height_above(plane, lamp.position_m);
        if (one.hidden[pixel] != 0) seen += one.of_shadow;
        if (lamp.floor_m <= 0.0 || one.hidden[pixel] != 0 || !rays[0].sees_floor()) continue;
        if (!one.of_edges.empty()) {
            const Eigen::Vector3d way = towards(lamp.position_m, rays[0]);
            for (std::size_t e = 0; e < one.of_edges.size(); ++e)
                if (one.edges->is_within(e, way)) seen += one.of_edges[e];
        }
        light_.add(lamp, rays, false, place);
    }
    found_.seen[pixel] = seen;
    for (std::size_t c = 0; c < kChannels; ++c)
        sample(c, pixel) = static_cast<float>(place.signals[c]);
}

// Points and normals are interpolated from the corners', and the same lamps light all of them.
bool ReliefPainter::is_smooth(const Cell& cell) const {
    const std::array<std::size_t, 4> at = corners_of(cell, relief_);
    for (const std::size_t corner : at)
        if (!relief_.knows(corner) || found_.seen[corner] != found_.seen[at[0]]) return false;
    const float most_m = kReliefOff * relief_.point_m[at[0]].norm();
    bool is = true;
    for_each_pixel(cell, relief_, [&](int column, int row) {
        const std::array<float, 4> shares = shares_at(cell, column, row);
        const std::size_t pixel = relief_.at(column, row);
        Eigen::Vector3f point_m = relief_.point_m[pixel];
        Eigen::Vector3f normal = relief_.normal[pixel];
        for (std::size_t k = 0; k < at.size(); ++k) {
            point_m -= shares[k] * relief_.point_m[at[k]];
            normal -= shares[k] * relief_.normal[at[k]];
        }
        is &= point_m.norm() <= most_m && normal.norm() <= kReliefOff;
        for (const LampOnRelief& lamp : lamps_) is &= lamp.hidden[pixel] == lamp.hidden[at[0]];
    });
    return is;
}

void ReliefPainter::fill(const Cell& cell) {
    const std::array<std::size_t, 4> at = corners_of(cell, relief_);
    const int column = (cell.column + cell.right) / 2;
    const int row = (cell.row + cell.below) / 2;
    bool is_right = is_smooth(cell);
    if (is_right && std::ranges::find(at, relief_.at(column, row)) == at.end()) {
        look(column, row);
        const std::array<float, 4> shares = shares_at(cell, column, row);
        for (std::size_t c = 0; c < kChannels; ++c) {
            float interpolated = 0.0F;
            for (std::size_t k = 0; k < at.size(); ++k)
                interpolated += shares[k] * sample(c, at[k]);
            const float there = sample(c, relief_.at(column, row));
            is_right &= std::abs(interpolated - there) <= kReliefError * there;
        }
    }
    for_each_pixel(cell, relief_, [&](int x, int y) {
        const std::size_t pixel = relief_.at(x, y);
        if (std::ranges::find(at, pixel) != at.end()) return;
        if (!is_right) {
            look(x, y);
            return;
        }
        const std::array<float, 4> shares = shares_at(cell, x, y);
        found_.seen[pixel] = found_.seen[at[0]];
        for (std::size_t c = 0; c < kChannels; ++c) {
            float interpolated = 0.0F;
            for (std::size_t k = 0; k < at.size(); ++k)
                interpolated += shares[k] * sample(c, at[k]);
            sample(c, pixel) = interpolated;
        }
    });
}

}  // namespace

ReliefLight relief_light(const Rig& rig,
                         const FloorLight& light,
                         const Relief& relief,
                         int threads) {
    const ReliefShadow shadow(relief);
    std::vector<BeamEdges> edges;
    for (const Strobe& strobe : rig.strobes) edges.emplace_back(strobe);
    std::mt19937 engine(1);  // numbers whose sums rarely coincide
    std::vector<LampOnRelief> lamps;
    for (const FloorLamp& lamp : light.lamps()) {
        lamps.push_back({.lamp = lamp,
                         .hidden = shadow_of(shadow, relief, lamp.position_m, threads),
                         .edges = &edges[lamp.strobe],
                         .of_shadow = static_cast<std::uint32_t>(engine()),
                         .of_edges = {}});
        for (std::size_t e = 0; e < edges[lamp.strobe].count(); ++e)
            lamps.back().of_edges.push_back(static_cast<std::uint32_t>(engine()));
    }
    ReliefPainter painter(light, relief, std::move(lamps));
    by_cells(
        relief,
        kReliefCell_px,
        threads,
        [&](int column, int row) { painter.look(column, row); },
        [&](const Cell& one) { painter.fill(one); });
    return painter.take();
}

}  // namespace aphotic
