// SPDX-License-Identifier: BSD-3-Clause
#include "light/signal_table.h"

#include "light/dispersion.h"
#include "spectral/light_family.h"

#include <algorithm>
#include <iterator>

namespace aphotic {
namespace {

// Shares of the requested error; the rest is for dispersion.
constexpr double kGridShare = 0.1;
constexpr double kTableShare = 0.5;
// Light with a ray for each wavelength varies faster with wavelength than light on a fixed path.
constexpr double kDispersedShare = 1e-4;
// The absolute values of Lagrange polynomials through three even points sum to at most 5/4.
constexpr double kLebesgue = 5.0 / 4.0;

using Grid = std::vector<WeightedWavelength>;

// The part of the grid that any channel sees.
Grid seen_of(const Grid& grid) {
    Grid seen;
    std::ranges::copy_if(grid, std::back_inserter(seen), [](const WeightedWavelength& node) {
        return std::ranges::any_of(node.weight, [](double weight) { return weight != 0.0; });
    });
    return seen;
}

// A lamp's light on the floor, and bare, for the floor's highlight.
struct LampLights {
    LightOf diffuse;
    LightOf highlight;
};
LampLights lights_of(const Rig& rig, const Spectrum& lamp) {
    return {.diffuse = [&](double nm) { return lamp.at(nm) * rig.seafloor.reflectance.at(nm); },
            .highlight = [&](double nm) { return lamp.at(nm); }};
}

LampSignal signal_of(const Rig& rig,
                     const Spectrum& lamp,
                     const Grid& grid,
                     const Grid& dispersed,
                     const PathSteps& steps) {
    const LampLights lights = lights_of(rig, lamp);
    const bool has_highlight = rig.seafloor.phong > 0.0;
    const std::vector<double> nodes_nm = index_nodes_nm(rig);
    LampSignal signal;
    for (std::size_t j = 0; j < nodes_nm.size(); ++j) {
        const auto tabulate = [&](const LightOf& light) {
            return path_table(spectral_sum(rig.water,
                                           grid,
                                           [&](double nm) {
                                               return index_share(rig, nodes_nm, j, nm) * light(nm);
                                           }),
                              steps);
        };
        signal.diffuse.push_back(tabulate(lights.diffuse));
        if (has_highlight) signal.highlight.push_back(tabulate(lights.highlight));
    }
    if (!disperses(rig)) return signal;
    signal.dispersed_diffuse = spectral_sum(rig.water, dispersed, lights.diffuse);
    if (has_highlight)
        signal.dispersed_highlight = spectral_sum(rig.water, dispersed, lights.highlight);
    return signal;
}

}  // namespace

std::vector<const Spectrum*> lamps_of(const Rig& rig, std::vector<std::size_t>& by_strobe) {
    std::vector<const Spectrum*> lamps;
    for (const Strobe& strobe : rig.strobes) {
        const auto known = std::ranges::find_if(
            lamps, [&](const Spectrum* lamp) { return is_same_curve(*lamp, strobe.spectrum); });
        by_strobe.push_back(static_cast<std::size_t>(known - lamps.begin()));
        if (known == lamps.end()) lamps.push_back(&strobe.spectrum);
    }
    return lamps;
}

SignalTable signal_table(const Rig& rig, const PathRange& paths, double error) {
    SignalTable table;
    const std::vector<const Spectrum*> lamps = lamps_of(rig, table.lamp_of_strobe);
    if (paths.longest_m == 0.0 || lamps.empty()) return table;
    const bool has_highlight = rig.seafloor.phong > 0.0;
    LightFamily family{.sources = {},
                       .water = rig.water,
                       .shortest_path_m = paths.shortest_m,
                       .longest_path_m = paths.longest_m};
    for (const Spectrum* lamp : lamps) {
        family.sources.push_back({*lamp, rig.seafloor.reflectance});
        if (has_highlight) family.sources.push_back({*lamp});
    }
    const auto grid_of = [&](double grid_error) {
        return reference_grid(rig.camera.sensor, family, rig.camera.range, grid_error);
    };
    const Grid grid = grid_of(kGridShare * error);
    table.grid_size = grid.size();
    Grid dispersed;
    if (disperses(rig)) {
        dispersed = seen_of(grid_of(kDispersedShare * error));
        table.ray_nodes_nm = index_nodes_nm(rig, kRayNodes);
        for (const WeightedWavelength& node : dispersed) {
            auto& shares = table.ray_shares.emplace_back();
            for (std::size_t j = 0; j < kRayNodes; ++j)
                shares[j] = index_share(rig, table.ray_nodes_nm, j, node.lambda_nm);
        }
    }
    const double table_error = kTableShare * error / (disperses(rig) ? kLebesgue : 1.0);
    const auto take_in = [&](const LightOf& light) {
        const PathSteps steps =
            path_steps(spectral_sum(rig.water, grid, light), paths, table_error);
        if (steps.count > table.steps.count) table.steps = steps;
    };
    for (const Spectrum* lamp : lamps) {
        const LampLights lights = lights_of(rig, *lamp);
        take_in(lights.diffuse);
        if (has_highlight) take_in(lights.highlight);
    }
    for (const Spectrum* lamp : lamps)
        table.lamps.push_back(signal_of(rig, *lamp, grid, dispersed, table.steps));
    return table;
}

}  // namespace aphotic
