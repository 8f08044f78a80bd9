// SPDX-License-Identifier: BSD-3-Clause
#include "light/relief_image.h"

#include "base/error.h"
#include "base/parallel.h"
#include "light/relief_shadow.h"

#include <algorithm>
#include <random>

namespace aphotic {
namespace {

// Of one lamp, by pixel: 0 where it is not hidden. Between the mesh's vertices it is the same where
// all four next to a cell agree.
std::vector<std::uint8_t> shadow_of(const ReliefShadow& shadow,
                                    const Relief& relief,
                                    const Eigen::Vector3d& lamp_m,
                                    int threads) {
    const int step = shadow.step_px();
    std::vector<std::uint8_t> hidden(relief.point_m.size());
    const auto look = [&](int column, int row) {
        const std::size_t pixel = relief.at(column, row);
        hidden[pixel] = relief.knows(pixel) && shadow.hides(pixel, lamp_m) ? 1 : 0;
    };
    const auto next = [step](int place, int count) { return std::min(place + step, count - 1); };
    const auto cells = static_cast<std::size_t>((relief.height_px + step - 1) / step);
    const auto for_rows = [&](const auto& work) {
        parallel_for(cells, static_cast<std::size_t>(threads), [&](std::size_t j, std::size_t) {
            work(static_cast<int>(j) * step);
        });
    };
    // The vertices of each row of cells, then what lies between.
    for_rows([&](int row) {
        for (int column = 0; column < relief.width_px; column += step) look(column, row);
        look(relief.width_px - 1, row);
    });
    for (int column = 0; column < relief.width_px; column += step)
        look(column, relief.height_px - 1);
    look(relief.width_px - 1, relief.height_px - 1);
    const std::vector<std::uint8_t> vertices = hidden;
    for_rows([&](int row) {
        const int below = next(row, relief.height_px);
        for (int column = 0; column < relief.width_px; column += step) {
            const int right = next(column, relief.width_px);
            const int sum = vertices[relief.at(column, row)] + vertices[relief.at(right, row)] +
                            vertices[relief.at(column, below)] + vertices[relief.at(right, below)];
            const bool is_even = sum == 0 || sum == 4;
            for (int y = row; y < std::min(row + step, relief.height_px); ++y) {
                for (int x = column; x < std::min(column + step, relief.width_px); ++x) {
                    if (is_even)
                        hidden[relief.at(x, y)] = sum == 4 ? 1 : 0;
                    else
                        look(x, y);
                }
            }
        }
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

}  // namespace

ReliefLight relief_light(const Rig& rig,
                         const FloorLight& light,
                         const Relief& relief,
                         int threads) {
    const ReliefShadow shadow(relief);
    std::vector<BeamEdges> edges;
    for (const Strobe& strobe : rig.strobes) edges.emplace_back(strobe);
    std::mt19937 engine(1);  // numbers whose sums are seldom the same by chance
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
    const std::size_t pixels = relief.point_m.size();
    ReliefLight found{.samples = std::vector<float>(kChannels * pixels),
                      .seen = std::vector<std::uint32_t>(pixels)};
    const auto paint = [&](int column, int row) {
        const std::size_t pixel = relief.at(column, row);
        if (!relief.knows(pixel)) return;
        const Plane plane = relief.plane(pixel);
        const PlaceRays rays = light.rays_at(column + 0.5, row + 0.5, plane);
        PlaceLight place;
        for (const LampOnRelief& one : lamps) {
            FloorLamp lamp = one.lamp;
            lamp.floor_m = height_above(plane, lamp.position_m);
            if (one.hidden[pixel] != 0) found.seen[pixel] += one.of_shadow;
            if (lamp.floor_m <= 0.0 || one.hidden[pixel] != 0 || !rays[0].sees_floor()) continue;
            const Eigen::Vector3d way = towards(lamp.position_m, rays[0]);
            for (std::size_t e = 0; e < one.of_edges.size(); ++e)
                if (one.edges->is_within(e, way)) found.seen[pixel] += one.of_edges[e];
            light.add(lamp, rays, false, place);
        }
        if (place.is_before || place.is_beyond)
            throw InputError(
                "pixel {}, {}: found a path of light that is {}; allowed: from {:g} to {:g} m",
                column,
                row,
                place.is_before ? "shorter" : "longer",
                kReliefPaths.shortest_m,
                kReliefPaths.longest_m);
        for (std::size_t c = 0; c < kChannels; ++c)
            found.samples[c * pixels + pixel] = static_cast<float>(place.signals[c]);
    };
    parallel_for(static_cast<std::size_t>(relief.height_px),
                 static_cast<std::size_t>(threads),
                 [&](std::size_t row, std::size_t) {
                     for (int column = 0; column < relief.width_px; ++column)
                         paint(column, static_cast<int>(row));
                 });
    return found;
}

}  // namespace aphotic
