// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/map_axes.h"

#include "base/degrees.h"
#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace aphotic {
namespace {

// Of a value that went through text and degrees.
constexpr double kSame = 1e-9;

struct NamedAxis {
    const char* name;
    const std::vector<double>* values;
    double shown;  // what a value is multiplied by for people
    bool is_ratio;
};

std::array<NamedAxis, 4> named(const MapAxes& axes) {
    return {{{"altitude_m", &axes.altitude_m, 1.0, true},
             {"pitch_deg", &axes.pitch_rad, kDegreesPerRadian, false},
             {"roll_deg", &axes.roll_rad, kDegreesPerRadian, false},
             {"water multiple", &axes.water_multiple, 1.0, false}}};
}

std::array<std::vector<double>*, 4> values_of(MapAxes& axes) {
    return {&axes.altitude_m, &axes.pitch_rad, &axes.roll_rad, &axes.water_multiple};
}

std::array<double, 4> coordinates_of(const MapPoint& point) {
    return {point.sled.altitude_m, point.sled.pitch_rad, point.sled.roll_rad, point.water_multiple};
}

MapPoint point_at(const std::array<double, 4>& x) {
    return {.sled = {.altitude_m = x[0], .pitch_rad = x[1], .roll_rad = x[2]},
            .water_multiple = x[3]};
}

struct Place {
    std::size_t lower;
    double share;  // of the upper one
};

Place place_on(const NamedAxis& axis, double value) {
    const std::vector<double>& values = *axis.values;
    const double room = kSame * std::max(1.0, std::abs(value));
    if (value < values.front() - room || value > values.back() + room || std::isnan(value)) {
        throw InputError(
            "{}: found {:.6g}; allowed: from {:.6g} to {:.6g}, which the "
            "atlas covers",
            axis.name,
            value * axis.shown,
            values.front() * axis.shown,
            values.back() * axis.shown);
    }
    if (values.size() == 1) return {.lower = 0, .share = 0.0};
    const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, value);
    const auto lower = static_cast<std::size_t>(above - values.begin()) - 1;
    const auto measure = [&](double x) { return axis.is_ratio ? std::log(x) : x; };
    const double from = measure(values[lower]);
    const double share = (measure(value) - from) / (measure(values[lower + 1]) - from);
    return {.lower = lower, .share = std::clamp(share, 0.0, 1.0)};
}

// Of the logarithms; NaN or infinity where one is black.
void add_logarithm(const std::vector<float>& samples, float weight, std::vector<float>& sum) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * std::log(samples[i]);
}

using LightPlanes = std::vector<float> Lightmap::*;

std::vector<float> blended_planes(std::span<const Lightmap* const> maps,
                                  std::span<const Neighbour> neighbours,
                                  LightPlanes planes) {
    std::vector<float> sum((maps[0]->*planes).size(), 0.0F);
    for (std::size_t n = 0; n < maps.size(); ++n)
        add_logarithm(maps[n]->*planes, static_cast<float>(neighbours[n].weight), sum);
    for (std::size_t i = 0; i < sum.size(); ++i) {
        if (std::isfinite(sum[i])) {
            sum[i] = std::exp(sum[i]);
            continue;
        }
        sum[i] = 0.0F;
        for (std::size_t n = 0; n < maps.size(); ++n)
            sum[i] += static_cast<float>(neighbours[n].weight) * (maps[n]->*planes)[i];
    }
    return sum;
}

}  // namespace

std::size_t bin_count(const MapAxes& axes) {
    return axes.altitude_m.size() * axes.pitch_rad.size() * axes.roll_rad.size() *
           axes.water_multiple.size();
}

std::vector<MapPoint> points_of(const MapAxes& axes) {
    std::vector<MapPoint> points;
    for (const double altitude_m : axes.altitude_m) {
        for (const double pitch_rad : axes.pitch_rad) {
            for (const double roll_rad : axes.roll_rad) {
                for (const double multiple : axes.water_multiple) {
                    points.push_back(point_at({altitude_m, pitch_rad, roll_rad, multiple}));
                }
            }
        }
    }
    return points;
}

std::vector<Neighbour> neighbours_of(const MapAxes& axes, const MapPoint& point) {
    const std::array<double, 4> x = coordinates_of(point);
    std::vector<Neighbour> neighbours{{.bin = 0, .weight = 1.0}};
    std::size_t a = 0;
    for (const NamedAxis& axis : named(axes)) {
        const Place place = place_on(axis, x[a++]);
        std::vector<Neighbour> finer;
        for (const Neighbour& coarse : neighbours) {
            const std::size_t bin = coarse.bin * axis.values->size() + place.lower;
            if (place.share < 1.0) {
                finer.push_back({.bin = bin, .weight = coarse.weight * (1.0 - place.share)});
            }
            if (place.share > 0.0) {
                finer.push_back({.bin = bin + 1, .weight = coarse.weight * place.share});
            }
        }
        neighbours = std::move(finer);
    }
    return neighbours;
}

std::size_t cell_count(const MapAxes& axes) {
    std::size_t count = 1;
    for (const NamedAxis& axis : named(axes)) {
        count *= std::max<std::size_t>(1, axis.values->size() - 1);
    }
    return count;
}

MapAxes cell_of(const MapAxes& axes, std::size_t cell) {
    MapAxes ends;
    const std::array<std::vector<double>*, 4> targets = values_of(ends);
    const std::array<NamedAxis, 4> all = named(axes);
    for (std::size_t a = all.size(); a-- > 0;) {  // the fastest first
        const std::vector<double>& values = *all[a].values;
        const std::size_t steps = std::max<std::size_t>(1, values.size() - 1);
        const std::size_t step = cell % steps;
        cell /= steps;
        *targets[a] = {values[step]};
        if (values.size() > 1) targets[a]->push_back(values[step + 1]);
    }
    return ends;
}

MapAxes with_middles(const MapAxes& axes) {
    MapAxes finer;
    const std::array<std::vector<double>*, 4> targets = values_of(finer);
    std::size_t a = 0;
    for (const NamedAxis& axis : named(axes)) {
        const std::vector<double>& values = *axis.values;
        std::vector<double>& target = *targets[a++];
        for (std::size_t i = 0; i + 1 < values.size(); ++i) {
            target.push_back(values[i]);
            target.push_back(axis.is_ratio ? std::sqrt(values[i] * values[i + 1])
                                           : std::midpoint(values[i], values[i + 1]));
        }
        target.push_back(values.back());
    }
    return finer;
}

Lightmap blended(std::span<const Lightmap* const> maps, std::span<const Neighbour> neighbours) {
    if (maps.size() == 1) return *maps[0];
    // Water taken 0 times has no veil, while its neighbour's has.
    std::vector<Lightmap> filled;
    filled.reserve(maps.size());
    std::vector<const Lightmap*> all(maps.begin(), maps.end());
    const bool has_veil =
        std::ranges::any_of(maps, [](const Lightmap* map) { return !map->veil.empty(); });
    for (const Lightmap*& map : all) {
        if (!has_veil || !map->veil.empty()) continue;
        filled.push_back(*map);
        filled.back().veil.assign(map->samples.size(), 0.0F);
        map = &filled.back();
    }
    return {.width_px = maps[0]->width_px,
            .height_px = maps[0]->height_px,
            .samples = blended_planes(all, neighbours, &Lightmap::samples),
            .veil = blended_planes(all, neighbours, &Lightmap::veil)};
}

}  // namespace aphotic
