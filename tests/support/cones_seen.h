// SPDX-License-Identifier: BSD-3-Clause
//
// For each pixel of a lightmap a number that identifies the edges of lamps' beams that enclose it:
// where two maps have equal numbers, no edge lies between them.
#pragma once

#include "light/beam_light.h"
#include "light/floor_light.h"
#include "light/path_range.h"
#include "light/signal_table.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace aphotic {

inline std::vector<double> cones_seen(const Rig& rig) {
    const SignalTable table = signal_table(rig, path_range(rig), 1e-5);
    const CameraRays rays(rig, 1);
    const FloorLight light(rig, rig.sled, table, rays);
    // Whole numbers below 2^40, whose sums are exact and rarely coincide.
    std::mt19937_64 engine(1);
    constexpr std::uint64_t kShift = 24;
    std::vector<BeamEdges> edges;
    for (const Strobe& strobe : rig.strobes) edges.emplace_back(strobe);
    std::vector<std::vector<double>> numbers;  // by lamp and edge
    for (const FloorLamp& lamp : light.lamps()) {
        numbers.emplace_back(edges[lamp.strobe].count());
        for (double& number : numbers.back()) number = static_cast<double>(engine() >> kShift);
    }
    std::vector<double> found;
    found.reserve(static_cast<std::size_t>(rig.camera.width_px * rig.camera.height_px));
    for (int row = 0; row < rig.camera.height_px; ++row) {
        for (int column = 0; column < rig.camera.width_px; ++column) {
            const FloorRay ray = light.rays_at(column + 0.5, row + 0.5)[0];
            double sum = 0.0;
            for (std::size_t k = 0; ray.sees_floor() && k < light.lamps().size(); ++k) {
                const FloorLamp& lamp = light.lamps()[k];
                const Eigen::Vector3d way = towards(lamp.position_m, ray);
                for (std::size_t e = 0; e < numbers[k].size(); ++e)
                    if (edges[lamp.strobe].is_within(e, way)) sum += numbers[k][e];
            }
            found.push_back(sum);
        }
    }
    return found;
}

}  // namespace aphotic
