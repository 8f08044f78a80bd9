// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/veil_map.h"

#include "base/parallel.h"
#include "rig/geometry.h"
#include "spectral/light_family.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

constexpr double kVeilGridShare = 0.1;
constexpr double kVeilTableShare = 0.5;

// A water whose direct light is lost at this one's c'.
Water lost_from_veil(const Rig& rig) {
    const std::vector<double> knots_nm = union_of_knots(rig.water.curves(), rig.camera.range);
    std::vector<double> loss_per_m;
    for (const double nm : knots_nm) {
        loss_per_m.push_back((rig.water.veil_attenuation_per_m(nm) - rig.water.uniform_loss_per_m) /
                             rig.water.multiple);
    }
    Water water = rig.water;
    water.absorption_per_m = Spectrum("loss of the veil", knots_nm, loss_per_m);
    water.scatterers.clear();
    return water;
}

// Of the wavelengths that are scattered.
double least_loss_per_m(const Rig& rig, const Water& water) {
    double least = std::numeric_limits<double>::infinity();
    for (const double nm : water.absorption_per_m.lambda_nm()) {
        for (std::size_t i = 0; i < rig.water.scatterers.size(); ++i) {
            if (rig.water.scattering_per_m(i, nm) > 0.0)
                least = std::min(least, water.attenuation_per_m(nm));
        }
    }
    return least;
}

PathRange veil_paths(const Rig& rig, const Water& water, const PathRange& direct) {
    double shortest_m = std::numeric_limits<double>::infinity();
    for (const Strobe& strobe : rig.strobes) {
        shortest_m = std::min(
            shortest_m, strobe.position_m.norm() - port_reach_m(rig) - emitter_reach_m(strobe));
    }
    PathRange paths{.shortest_m = std::max(0.0, shortest_m), .longest_m = direct.longest_m};
    if (direct.has_horizon || direct.longest_m == 0.0) {
        const double least_per_m = least_loss_per_m(rig, water);
        if (std::isfinite(least_per_m)) paths.longest_m = kVeilDepth / least_per_m;
    }
    paths.longest_m = std::max(paths.longest_m, paths.shortest_m + 1.0);
    return paths;
}

SpectralSum veil_sum(const Rig& rig,
                     const Water& water,
                     const std::vector<WeightedWavelength>& grid,
                     const Spectrum& lamp,
                     std::size_t scatterer) {
    const auto count = static_cast<Eigen::Index>(grid.size());
    SpectralSum sum{.K_per_m = Eigen::ArrayXd(count), .weights = Eigen::ArrayXXd(count, kChannels)};
    for (Eigen::Index i = 0; i < count; ++i) {
        const WeightedWavelength& node = grid[static_cast<std::size_t>(i)];
        sum.K_per_m(i) = water.attenuation_per_m(node.lambda_nm);
        const double light =
            lamp.at(node.lambda_nm) * rig.water.scattering_per_m(scatterer, node.lambda_nm);
        for (Eigen::Index c = 0; c < kChannels; ++c)
            sum.weights(i, c) = node.weight[static_cast<std::size_t>(c)] * light;
    }
    return sum;
}

double middle_index_nm(const Rig& rig) {
    const WavelengthRange range = rig.camera.range;
    const double middle = 0.5 * (rig.water.refractive_index(range.first_nm) +
                                 rig.water.refractive_index(range.last_nm));
    double low_nm = range.first_nm;
    double high_nm = range.last_nm;
    constexpr int kHalvings = 60;
    for (int i = 0; i < kHalvings; ++i) {
        const double nm = 0.5 * (low_nm + high_nm);
        (rig.water.refractive_index(nm) > middle ? low_nm : high_nm) = nm;
    }
    return low_nm;
}

}  // namespace

VeilMap::VeilMap(const Rig& rig, const PathRange& direct, double error)
    : rig_(rig), veil_(rig), lambda_nm_(middle_index_nm(rig)) {
    const Water water = lost_from_veil(rig);
    const PathRange paths = veil_paths(rig, water, direct);
    LightFamily family{.sources = {},
                       .water = water,
                       .shortest_path_m = paths.shortest_m,
                       .longest_path_m = paths.longest_m};
    for (const Strobe& strobe : rig.strobes) {
        for (const Scatterer& scatterer : rig.water.scatterers)
            family.sources.push_back({strobe.spectrum, scatterer.scattering_per_m});
    }
    const auto grid =
        reference_grid(rig.camera.sensor, family, rig.camera.range, kVeilGridShare * error);
    std::vector<SpectralSum> sums;
    for (const Strobe& strobe : rig.strobes) {
        std::size_t first = 0;
        while (!is_same_curve(rig.strobes[first].spectrum, strobe.spectrum)) ++first;
        const bool is_known = first < first_table_.size();
        first_table_.push_back(is_known ? first_table_[first] : sums.size());
        for (std::size_t i = 0; i < rig.water.scatterers.size() && !is_known; ++i) {
            sums.push_back(veil_sum(rig, water, grid, strobe.spectrum, i));
            const PathSteps steps = path_steps(sums.back(), paths, kVeilTableShare * error);
            if (steps.count > steps_.count) steps_ = steps;
        }
    }
    for (const SpectralSum& sum : sums) tables_.push_back(path_table(sum, steps_));
}

VeilMap::Signal VeilMap::table_at(const std::vector<float>& table, double path_m) const {
    const double place = (path_m - steps_.first_m) * steps_.steps_per_m;
    // Rounding may lead out of it a little; beyond the horizon's end nothing is left.
    const int step = std::clamp(static_cast<int>(place), 0, steps_.count - 1);
    const double t = place - step;
    const float* const of_step = &table[static_cast<std::size_t>(step) * kTableStride];
    Signal signal{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto at = [&](std::size_t order) {
            return static_cast<double>(of_step[order * kTableLanes + c]);
        };
        signal[c] = at(0) + t * (at(1) + t * (at(2) + t * at(3)));
    }
    return signal;
}

VeilMap::Signal VeilMap::at(const Rig& flown, int column, int row, VeilNodes& nodes) const {
    const VeilSight sight = sight_of(flown, column + 0.5, row + 0.5, lambda_nm_);
    Signal sum{};
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        veil_.nodes(s, sight.ray, sight.length_m, nodes);
        for (std::size_t i = 0; i < nodes.weight.size(); ++i) {
            const std::vector<float>& table = tables_[first_table_[s] + i];
            Signal of_scatterer{};
            for (std::size_t n = 0; n < nodes.path_m.size(); ++n) {
                const Signal T = table_at(table, nodes.path_m[n]);
                for (std::size_t c = 0; c < kChannels; ++c)
                    of_scatterer[c] += nodes.weight[i][n] * T[c];
            }
            for (std::size_t c = 0; c < kChannels; ++c)
                sum[c] += rig_.strobes[s].power * of_scatterer[c];
        }
    }
    return sum;
}

void VeilMap::rows_into(
    const Sled& sled, int first_row, int count, int threads, std::vector<float>& samples) const {
    const auto width = static_cast<std::size_t>(rig_.camera.width_px);
    const auto rows = static_cast<std::size_t>(count);
    samples.resize(kChannels * width * rows);
    Rig flown = rig_;
    flown.sled = sled;
    std::vector<VeilNodes> nodes(static_cast<std::size_t>(threads));
    parallel_for(rows, nodes.size(), [&](std::size_t row, std::size_t thread) {
        for (std::size_t column = 0; column < width; ++column) {
            const Signal found = at(
                flown, static_cast<int>(column), first_row + static_cast<int>(row), nodes[thread]);
            for (std::size_t c = 0; c < kChannels; ++c)
                samples[(c * rows + row) * width + column] = static_cast<float>(found[c]);
        }
    });
}

}  // namespace aphotic
