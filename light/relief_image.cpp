// SPDX-License-Identifier: BSD-3-Clause
#include "light/relief_image.h"

#include "base/parallel.h"
#include "light/relief_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <random>
#include <span>
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

struct Pixel {
    int column;
    int row;
};

// Calls look(pixels) for the vertices of each row of cells, then fill(cells) for each row, which
// does not change the vertices.
template <typename Look, typename Fill>
void by_cells(const Relief& relief, int step_px, int threads, const Look& look, const Fill& fill) {
    const std::vector<int> columns = every(step_px, relief.width_px);
    const std::vector<int> rows = every(step_px, relief.height_px);
    const auto each = [&](std::size_t count, const auto& work) {
        parallel_for(
            count, static_cast<std::size_t>(threads), [&](std::size_t j, std::size_t) { work(j); });
    };
    each(rows.size(), [&](std::size_t j) {
        std::vector<Pixel> vertices;
        for (const int column : columns) vertices.push_back({column, rows[j]});
        look(vertices);
    });
    each(rows.size() - 1, [&](std::size_t j) {
        std::vector<Cell> cells;
        for (std::size_t i = 0; i + 1 < columns.size(); ++i)
            cells.push_back({.column = columns[i],
                             .row = rows[j],
                             .right = columns[i + 1],
                             .below = rows[j + 1]});
        fill(cells);
    });
}

// For one lamp, by pixel: 0 where it is visible. Between vertices of the mesh the value is shared
// if all four corners of a cell agree.
std::vector<std::uint8_t> shadow_of(const ReliefShadow& shadow,
                                    const Relief& relief,
                                    const Eigen::Vector3d& lamp_m,
                                    int threads) {
    std::vector<std::uint8_t> hidden(relief.point_m.size());
    const auto look = [&](std::span<const Pixel> pixels) {
        for (const auto& [column, row] : pixels) {
            const std::size_t pixel = relief.at(column, row);
            hidden[pixel] = relief.knows(pixel) && shadow.hides(pixel, lamp_m) ? 1 : 0;
        }
    };
    const auto fill = [&](const std::vector<Cell>& cells) {
        std::vector<Pixel> uneven;
        for (const Cell& cell : cells) {
            const std::array<std::size_t, 4> at = corners_of(cell, relief);
            const bool is_even =
                std::ranges::all_of(at, [&](std::size_t k) { return hidden[k] == hidden[at[0]]; });
            for_each_pixel(cell, relief, [&](int column, int row) {
                const std::size_t pixel = relief.at(column, row);
                if (std::ranges::find(at, pixel) != at.end()) return;
                if (is_even)
                    hidden[pixel] = hidden[at[0]];
                else
                    uneven.push_back({column, row});
            });
        }
        look(uneven);
    };
    by_cells(relief, shadow.step_px(), threads, look, fill);
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

    void look(std::span<const Pixel> pixels);
    void fill(const std::vector<Cell>& cells);
    [[nodiscard]] ReliefLight take() { return std::move(found_); }

  private:
    [[nodiscard]] float& sample(std::size_t channel, std::size_t pixel) {
        return found_.samples[channel * relief_.point_m.size() + pixel];
    }
    [[nodiscard]] bool is_smooth(const Cell& cell) const;
    [[nodiscard]] float interpolated(const Cell& cell, std::size_t channel, const Pixel& at);
    [[nodiscard]] bool is_right(const Cell& cell, const Pixel& middle);
    void look_at_lanes(std::span<const Pixel> pixels);

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

void ReliefPainter::look(std::span<const Pixel> pixels) {
    std::vector<Pixel> known;
    std::ranges::copy_if(pixels, std::back_inserter(known), [&](const Pixel& at) {
        return relief_.knows(relief_.at(at.column, at.row));
    });
    for (std::size_t first = 0; first < known.size(); first += kLanes)
        look_at_lanes(std::span(known).subspan(first, std::min(kLanes, known.size() - first)));
}

// To the planes' points, which without a port determine their rays, whatever pixels they belong to.
LaneRays rays_from_pupil(const LanePlane& floor) {
    LaneRays rays;
    rays.count = 1;
    LaneRay& ray = rays.ray[0];
    ray.origin_m = every_lane(Eigen::Vector3d::Zero());
    for_each_pack([&](std::size_t k) {
        PackVector way = pack(floor.point_m, k);
        const Pack per_length = 1.0 / root(dot(way, way));
        for (Pack& along : way) along *= per_length;
        set_pack(ray.direction, k, way);
    });
    meet(floor, ray);
    return rays;
}

// Spare lanes repeat the last pixel.
void ReliefPainter::look_at_lanes(std::span<const Pixel> pixels) {
    std::array<std::size_t, kLanes> pixel;
    Lanes column;
    Lanes row;
    LanePlane floor;
    for (std::size_t k = 0; k < kLanes; ++k) {
        const Pixel& at = pixels[std::min(k, pixels.size() - 1)];
        pixel[k] = relief_.at(at.column, at.row);
        const Plane plane = relief_.plane(pixel[k]);
        column[k] = at.column + 0.5;
        row[k] = at.row + 0.5;
        set_lane(floor.point_m, k, plane.point_m);
        set_lane(floor.normal, k, plane.normal);
    }
    const LaneRays rays =
        light_.has_port() ? light_.rays_at(column, row, floor) : rays_from_pupil(floor);
    const LaneRay& middle = rays.ray[0];
    LaneLight light;
    std::array<std::uint32_t, kLanes> seen{};
    for (const LampOnRelief& one : lamps_) {
        FloorLamp lamp = one.lamp;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const Plane plane{.point_m = vector_of_lane(floor.point_m, k),
                              .normal = vector_of_lane(floor.normal, k)};
            const bool is_hidden = one.hidden[pixel[k]] != 0;
            if (is_hidden) seen[k] += one.of_shadow;
            lamp.floor_m[k] = is_hidden ? 0.0 : std::max(0.0, height_above(plane, lamp.position_m));
        }
        for (std::size_t e = 0; e < one.of_edges.size(); ++e) {
            LaneVector V;
            for_each_pack(
                [&](std::size_t k) { set_pack(V, k, towards(lamp.position_m, middle, k)); });
            for (std::size_t k = 0; k < kLanes; ++k)
                if (lamp.floor_m[k] > 0.0 && middle.down[k] > 0.0 &&
                    one.edges->is_within(e, vector_of_lane(V, k)))
                    seen[k] += one.of_edges[e];
        }
        light_.add(lamp, rays, light);
    }
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        found_.seen[pixel[k]] = seen[k];
        for (std::size_t c = 0; c < kChannels; ++c)
            sample(c, pixel[k]) = static_cast<float>(light.signals[c][k]);
    }
}

// Whether points and normals agree with those interpolated from the corners, and the same lamps
// light all of them.
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

float ReliefPainter::interpolated(const Cell& cell, std::size_t channel, const Pixel& at) {
    const std::array<std::size_t, 4> corners = corners_of(cell, relief_);
    const std::array<float, 4> shares = shares_at(cell, at.column, at.row);
    float sum = 0.0F;
    for (std::size_t k = 0; k < corners.size(); ++k) sum += shares[k] * sample(channel, corners[k]);
    return sum;
}

bool ReliefPainter::is_right(const Cell& cell, const Pixel& middle) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        const float there = sample(c, relief_.at(middle.column, middle.row));
        if (!(std::abs(interpolated(cell, c, middle) - there) <= kReliefError * there))
            return false;
    }
    return true;
}

// A row of cells: pixels that must be computed are gathered into lanes.
void ReliefPainter::fill(const std::vector<Cell>& cells) {
    const auto middle_of = [](const Cell& cell) {
        return Pixel{(cell.column + cell.right) / 2, (cell.row + cell.below) / 2};
    };
    std::vector<Cell> smooth;
    std::vector<Pixel> middles;
    std::vector<Pixel> rest;
    const auto for_each_within = [&](const Cell& cell, const auto& work) {
        const std::array<std::size_t, 4> corners = corners_of(cell, relief_);
        for_each_pixel(cell, relief_, [&](int column, int row) {
            const std::size_t pixel = relief_.at(column, row);
            if (std::ranges::find(corners, pixel) == corners.end()) work(pixel, Pixel{column, row});
        });
    };
    const auto look_later = [&](std::size_t, const Pixel& at) { rest.push_back(at); };
    for (const Cell& cell : cells) {
        if (is_smooth(cell)) {
            smooth.push_back(cell);
            middles.push_back(middle_of(cell));
        } else {
            for_each_within(cell, look_later);
        }
    }
    look(middles);
    for (const Cell& cell : smooth) {
        if (!is_right(cell, middle_of(cell))) {
            for_each_within(cell, look_later);
            continue;
        }
        const std::uint32_t seen = found_.seen[relief_.at(cell.column, cell.row)];
        for_each_within(cell, [&](std::size_t pixel, const Pixel& at) {
            found_.seen[pixel] = seen;
            for (std::size_t c = 0; c < kChannels; ++c)
                sample(c, pixel) = interpolated(cell, c, at);
        });
    }
    look(rest);
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
        [&](const std::vector<Pixel>& vertices) { painter.look(vertices); },
        [&](const std::vector<Cell>& cells) { painter.fill(cells); });
    return painter.take();
}

}  // namespace aphotic
