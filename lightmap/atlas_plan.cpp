// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/atlas_plan.h"

#include "scene_gen/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace aphotic {
namespace {

// An eighth of HabCam's image, or so: the light is as smooth there, for it knows no pixels.
Rig probe_of(const Rig& rig) {
    Rig probe = rig;
    const double coarser = std::max(1.0, static_cast<double>(rig.camera.width_px) / kProbe_px);
    const auto fewer = [&](int pixels) {
        return std::max(1, static_cast<int>(std::lround(pixels / coarser)));
    };
    probe.camera.width_px = fewer(rig.camera.width_px);
    probe.camera.height_px = fewer(rig.camera.height_px);
    probe.camera.pixel_pitch_m *= coarser;
    return probe;
}

// The same light without an edge: every cone goes on to 90 degrees.
Rig smooth_of(Rig rig) {
    for (Strobe& strobe : rig.strobes) {
        for (Cone& cone : strobe.beam.cones) {
            cone.weight = axial_intensity(cone, strobe.beam.weights);
            cone.half_angle_rad = 0.5 * std::numbers::pi;
        }
        strobe.beam.weights = ConeWeights::Literal;
    }
    return rig;
}

LightmapOptions probe_options() {
    return {.error = 1e-6, .threads = 1};
}

// What is found in one cell after another.
struct Tally {
    double worst = 0.0;
    double squares = 0.0;
    double samples = 0.0;
    double crossed = 0.0;
    double pixels = 0.0;
};

std::array<float, kChannels> dimmest_of(const Lightmap& map) {
    std::array<float, kChannels> dimmest{};
    const auto size = static_cast<std::ptrdiff_t>(map.samples.size() / kChannels);
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto first = map.samples.begin() + static_cast<std::ptrdiff_t>(c) * size;
        dimmest[c] = kDimShare * *std::max_element(first, first + size);
    }
    return dimmest;
}

// Both with a probe's image.
struct Probe {
    Probe(const Rig& rig, const MapAxes& within)
        : sharp(probe_of(rig), within, probe_options()),
          smooth(smooth_of(probe_of(rig)), within, probe_options()) {}

    MapSource sharp;
    MapSource smooth;
};

void count_crossed(MapSource& sharp,
                   const std::vector<MapPoint>& corners,
                   const MapPoint& point,
                   Tally& tally) {
    const std::vector<double> cones = sharp.cones(point);
    std::vector<char> is_crossed(cones.size(), 0);
    for (const MapPoint& corner : corners) {
        const std::vector<double> there = sharp.cones(corner);
        for (std::size_t i = 0; i < cones.size(); ++i) {
            if (there[i] != cones[i]) is_crossed[i] = 1;
        }
    }
    tally.crossed += static_cast<double>(std::ranges::count(is_crossed, 1));
    tally.pixels += static_cast<double>(cones.size());
}

void compare(Probe& probe, const MapAxes& axes, const MapPoint& point, Tally& tally) {
    const std::vector<MapPoint> points = points_of(axes);
    const std::vector<Neighbour> neighbours = neighbours_of(axes, point);
    std::vector<MapPoint> corners;
    std::vector<Lightmap> maps;
    for (const Neighbour& neighbour : neighbours) {
        corners.push_back(points[neighbour.bin]);
        maps.push_back(probe.smooth.map(corners.back()));
    }
    std::vector<const Lightmap*> about;
    for (const Lightmap& map : maps) about.push_back(&map);
    const Lightmap between = blended(about, neighbours);
    const Lightmap truth = probe.smooth.map(point);
    const std::array<float, kChannels> dimmest = dimmest_of(truth);
    const std::size_t plane = truth.samples.size() / kChannels;
    for (std::size_t i = 0; i < truth.samples.size(); ++i) {
        const float scale = std::max(truth.samples[i], dimmest[i / plane]);
        if (scale == 0.0F) continue;
        const double error = std::abs(between.samples[i] - truth.samples[i]) / scale;
        tally.worst = std::max(tally.worst, error);
        tally.squares += error * error;
        tally.samples += 1.0;
    }
    count_crossed(probe.sharp, corners, point, tally);
}

std::vector<double> ends_of(const std::vector<double>& values) {
    if (values.size() == 1) return values;
    return {values.front(), values.back()};
}

// As few values as keep the error from each to the next: each step goes as far as it may.
std::vector<double> sparse(const std::vector<double>& values,
                           double tolerance,
                           const std::function<double(double, double)>& error_between) {
    std::vector<double> kept{values.front()};
    std::size_t at = 0;
    while (at + 1 < values.size()) {
        std::size_t next = at + 1;
        while (next + 1 < values.size() &&
               error_between(values[at], values[next + 1]) <= tolerance) {
            ++next;
        }
        kept.push_back(values[next]);
        at = next;
    }
    return kept;
}

}  // namespace

MapSource::MapSource(const Rig& rig, const MapAxes& within, const LightmapOptions& options)
    : rig_(rig), options_(options) {
    MapAxes ends{.altitude_m = ends_of(within.altitude_m),
                 .pitch_rad = ends_of(within.pitch_rad),
                 .roll_rad = ends_of(within.roll_rad),
                 .water_multiple = {1.0}};
    for (const MapPoint& point : points_of(ends)) ends_.push_back(point.sled);
}

const LightmapMaker& MapSource::maker(double water_multiple) {
    std::unique_ptr<LightmapMaker>& maker = makers_[water_multiple];
    if (!maker) {
        Rig rig = rig_;
        rig.water.multiple = water_multiple;
        maker = std::make_unique<LightmapMaker>(rig, paths_of(rig, ends_), options_);
    }
    return *maker;
}

Lightmap MapSource::map(const MapPoint& point) {
    return maker(point.water_multiple).map(point.sled);
}

Lightmap MapSource::rows(const MapPoint& point, int first_row, int count) {
    Lightmap map;
    maker(point.water_multiple).rows_into(point.sled, first_row, count, map);
    return map;
}

std::vector<double> MapSource::cones(const MapPoint& point) {
    return maker(point.water_multiple).cones(point.sled);
}

InterpolationError interpolation_error(const Rig& rig, const MapAxes& axes) {
    Probe probe(rig, axes);
    Tally tally;
    for (const MapPoint& middle : middles_of(axes)) compare(probe, axes, middle, tally);
    return {.worst = tally.worst,
            .rms = tally.samples > 0.0 ? std::sqrt(tally.squares / tally.samples) : 0.0,
            .crossed_share = tally.crossed / tally.pixels};
}

MapAxes axes_for(const Rig& rig, const MapAxes& finest, double tolerance) {
    Probe probe(rig, finest);
    MapAxes chosen = finest;
    using Axis = std::vector<double> MapAxes::*;
    constexpr std::array<Axis, 4> kAxes{
        &MapAxes::altitude_m, &MapAxes::pitch_rad, &MapAxes::roll_rad, &MapAxes::water_multiple};
    const auto moving =
        std::ranges::count_if(kAxes, [&](Axis axis) { return (finest.*axis).size() > 1; });
    for (const Axis axis : kAxes) {
        const auto error_between = [&](double from, double to) {
            // The others where they end: there the light is steepest.
            MapAxes cell;
            for (const Axis other : kAxes) cell.*other = ends_of(finest.*other);
            Tally tally;
            for (const MapPoint& corner : points_of(cell)) {
                MapAxes line{.altitude_m = {corner.sled.altitude_m},
                             .pitch_rad = {corner.sled.pitch_rad},
                             .roll_rad = {corner.sled.roll_rad},
                             .water_multiple = {corner.water_multiple}};
                line.*axis = {from, to};
                compare(probe, line, middles_of(line).front(), tally);
            }
            return tally.worst;
        };
        const double share = tolerance / static_cast<double>(std::max<std::ptrdiff_t>(1, moving));
        chosen.*axis = sparse(finest.*axis, share, error_between);
    }
    return chosen;
}

}  // namespace aphotic
