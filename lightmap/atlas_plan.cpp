// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/atlas_plan.h"

#include "base/parallel.h"
#include "rig/geometry.h"
#include "rig/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace aphotic {
namespace {

// A twentieth of HabCam's image, or so: the light is as smooth there, for it knows no pixels. Its
// outermost pixels lie where the image's own do, or as little further out as makes them whole. Of a
// calibrated lens, which need not show more than the image, they lie half of their size within.
Rig probe_of(const Rig& rig) {
    Rig probe = rig;
    if (rig.camera.width_px <= kProbe_px) return probe;
    if (rig.camera.lens) {
        const double coarser = static_cast<double>(rig.camera.width_px) / kProbe_px;
        const double height_px = std::floor(rig.camera.height_px / coarser);
        enlarge_pixels(probe.camera, coarser, kProbe_px, std::max(1, static_cast<int>(height_px)));
        return probe;
    }
    const double coarser = (rig.camera.width_px - 1.0) / (kProbe_px - 1.0);
    const double height_px = 1.0 + std::ceil((rig.camera.height_px - 1.0) / coarser);
    enlarge_pixels(probe.camera, coarser, kProbe_px, static_cast<int>(height_px));
    return probe;
}

Rig smooth_of(Rig rig) {
    for (Strobe& strobe : rig.strobes) strobe.beam = without_edges(strobe.beam);
    return rig;
}

LightmapOptions probe_options() {
    return {.error = 1e-6, .threads = 1};
}

// What is found at points between bins, one after another.
struct Tally {
    double worst = 0.0;
    double squares = 0.0;
    double samples = 0.0;
    double over = 0.0;  // samples off by more than a limit
    double crossed = 0.0;
    double pixels = 0.0;

    void add(const Tally& other) {
        worst = std::max(worst, other.worst);
        squares += other.squares;
        samples += other.samples;
        over += other.over;
        crossed += other.crossed;
        pixels += other.pixels;
    }
};

double rms_of(const Tally& tally) {
    return tally.samples > 0.0 ? std::sqrt(tally.squares / tally.samples) : 0.0;
}

std::array<float, kChannels> dimmest_of(const std::vector<float>& signal) {
    std::array<float, kChannels> dimmest{};
    const auto size = static_cast<std::ptrdiff_t>(signal.size() / kChannels);
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto first = signal.begin() + static_cast<std::ptrdiff_t>(c) * size;
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

// What errors are relative to, and what is counted of them.
enum class Against { Truth, LargerOfBoth };
struct Measure {
    Against against = Against::Truth;
    double limit = 0.0;
};

Tally compare(const Lightmap& between, const Lightmap& truth, const Measure& measure) {
    Tally tally;
    const std::vector<float> wanted = signal_of(truth);
    const std::vector<float> found = signal_of(between);
    const std::array<float, kChannels> dimmest = dimmest_of(wanted);
    const std::size_t plane = wanted.size() / kChannels;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        float scale = std::max(wanted[i], dimmest[i / plane]);
        if (measure.against == Against::LargerOfBoth) scale = std::max(scale, found[i]);
        if (scale == 0.0F) continue;
        const double error = std::abs(found[i] - wanted[i]) / scale;
        tally.worst = std::max(tally.worst, error);
        tally.squares += error * error;
        tally.samples += 1.0;
        tally.over += error > measure.limit ? 1.0 : 0.0;
    }
    return tally;
}

// The maps of a cell's corners, and the points between them.
class Cell {
  public:
    Cell(MapSource& source, MapAxes ends) : source_(source), ends_(std::move(ends)) {
        for (const MapPoint& corner : points_of(ends_)) maps_.push_back(source.map(corner));
    }

    [[nodiscard]] Tally error_at(const MapPoint& point, const Measure& measure) const {
        const std::vector<Neighbour> neighbours = neighbours_of(ends_, point);
        std::vector<const Lightmap*> about;
        about.reserve(neighbours.size());
        for (const Neighbour& neighbour : neighbours) about.push_back(&maps_[neighbour.bin]);
        return compare(blended(about, neighbours), source_.map(point), measure);
    }

  private:
    MapSource& source_;
    MapAxes ends_;
    std::vector<Lightmap> maps_;
};

// By how much an axis' share of the tolerance shrinks at a time, and when it takes all its values.
constexpr double kShrink = 0.75;
constexpr double kShareThatCounts = 1e-3;

using Axis = std::vector<double> MapAxes::*;
constexpr std::array<Axis, 4> kAxes{
    &MapAxes::altitude_m, &MapAxes::pitch_rad, &MapAxes::roll_rad, &MapAxes::water_multiple};

// The middles of a cell's edges and faces and its own, but for those that the next cell has too.
std::vector<MapPoint> own_middles(const MapAxes& axes, const MapAxes& cell) {
    MapAxes grid = with_middles(cell);
    for (const Axis axis : kAxes) {
        if ((cell.*axis).back() != (axes.*axis).back()) (grid.*axis).pop_back();
    }
    std::vector<MapPoint> middles = points_of(grid);
    std::erase_if(middles,
                  [&](const MapPoint& point) { return neighbours_of(cell, point).size() == 1; });
    return middles;
}

MapPoint middle_of(const MapAxes& cell) {
    MapAxes middle = with_middles(cell);
    for (const Axis axis : kAxes) middle.*axis = {(middle.*axis)[(middle.*axis).size() / 2]};
    return points_of(middle).front();
}

void count_crossed(MapSource& sharp, const MapAxes& cell, const MapPoint& point, Tally& tally) {
    const std::vector<double> cones = sharp.cones(point);
    std::vector<char> is_crossed(cones.size(), 0);
    for (const MapPoint& corner : points_of(cell)) {
        const std::vector<double> there = sharp.cones(corner);
        for (std::size_t i = 0; i < cones.size(); ++i) {
            if (there[i] != cones[i]) is_crossed[i] = 1;
        }
    }
    tally.crossed += static_cast<double>(std::ranges::count(is_crossed, 1));
    tally.pixels += static_cast<double>(cones.size());
}

// Of all cells, one after another; threads take them as they come free.
std::vector<Tally> tallies_of(std::size_t cells,
                              const MeasureOptions& options,
                              const std::function<Tally(std::size_t)>& measure) {
    std::vector<Tally> tallies(cells);
    const auto take = [&](std::size_t i, std::size_t thread) {
        if (thread == 0 && options.progress) {
            options.progress(static_cast<double>(i) / static_cast<double>(cells));
        }
        tallies[i] = measure(i);
    };
    parallel_for(cells, static_cast<std::size_t>(options.threads), take);
    return tallies;
}

Tally sum_of(const std::vector<Tally>& tallies) {
    Tally sum;
    for (const Tally& tally : tallies) sum.add(tally);
    return sum;
}

std::vector<Tally> light_tallies(Probe& probe, const MapAxes& axes, const MeasureOptions& options) {
    return tallies_of(cell_count(axes), options, [&](std::size_t i) {
        const MapAxes ends = cell_of(axes, i);
        const Cell cell(probe.smooth, ends);
        Tally tally;
        for (const MapPoint& point : own_middles(axes, ends)) tally.add(cell.error_at(point, {}));
        return tally;
    });
}

// From one cell that is looked at to the next: without a common factor with their number, so that
// no axis is seen at the same few places alone.
std::size_t whole_stride(std::size_t cells) {
    std::size_t stride = (cells + kWholeCells - 1) / kWholeCells;
    while (std::gcd(stride, cells) > 1) ++stride;
    return stride;
}

std::vector<Tally> whole_tallies(Probe& probe,
                                 const MapAxes& axes,
                                 double limit,
                                 const MeasureOptions& options) {
    const std::size_t cells = cell_count(axes);
    const std::size_t stride = whole_stride(cells);
    return tallies_of((cells + stride - 1) / stride, options, [&](std::size_t i) {
        const MapAxes ends = cell_of(axes, i * stride);
        const MapPoint middle = middle_of(ends);
        Tally tally = Cell(probe.sharp, ends)
                          .error_at(middle, {.against = Against::LargerOfBoth, .limit = limit});
        count_crossed(probe.sharp, ends, middle, tally);
        return tally;
    });
}

InterpolationError stated(const Tally& light, const std::vector<Tally>& whole, double limit) {
    const Tally sum = sum_of(whole);
    return {.worst = light.worst,
            .rms = rms_of(light),
            .whole_cells = whole.size(),
            .crossed_share = sum.crossed / sum.pixels,
            .whole_rms = rms_of(sum),
            .whole_limit = limit,
            .whole_over = sum.over / std::max(1.0, sum.samples)};
}

std::vector<double> ends_of(const std::vector<double>& values) {
    if (values.size() == 1) return values;
    return {values.front(), values.back()};
}

// As few values as keep the error from each to the next: each step goes as far as it may, found by
// doubling it and then by halves.
std::vector<double> sparse(const std::vector<double>& values,
                           double tolerance,
                           const std::function<double(double, double)>& error_between) {
    std::vector<double> kept{values.front()};
    const std::size_t last = values.size() - 1;
    for (std::size_t at = 0; at < last;) {
        const auto holds = [&](std::size_t next) {
            return error_between(values[at], values[next]) <= tolerance;
        };
        std::size_t good = at + 1;
        std::size_t bad = last + 1;
        while (good < last && bad > last) {
            const std::size_t next = std::min(last, at + 2 * (good - at));
            (holds(next) ? good : bad) = next;
        }
        while (bad <= last && bad - good > 1) {
            const std::size_t next = std::midpoint(good, bad);
            (holds(next) ? good : bad) = next;
        }
        kept.push_back(values[good]);
        at = good;
    }
    return kept;
}

// The largest error in the middle of a step of one axis, over all ends of the others: there the
// light is steepest.
double error_of_step(
    Probe& probe, const MapAxes& finest, Axis axis, const std::vector<double>& step, int threads) {
    MapAxes others;
    for (const Axis other : kAxes) others.*other = ends_of(finest.*other);
    others.*axis = {step.front()};
    const std::vector<MapPoint> corners = points_of(others);
    std::vector<double> errors(corners.size());
    const auto measure = [&](std::size_t i, std::size_t) {
        MapAxes line{.altitude_m = {corners[i].sled.altitude_m},
                     .pitch_rad = {corners[i].sled.pitch_rad},
                     .roll_rad = {corners[i].sled.roll_rad},
                     .water_multiple = {corners[i].water_multiple}};
        line.*axis = step;
        errors[i] = Cell(probe.smooth, line).error_at(middle_of(line), {}).worst;
    };
    parallel_for(corners.size(), static_cast<std::size_t>(threads), measure);
    return *std::ranges::max_element(errors);
}

std::vector<double> chosen_values(
    Probe& probe, const MapAxes& finest, Axis axis, double share, const MeasureOptions& options) {
    const std::vector<double>& values = finest.*axis;
    return sparse(values, share, [&](double from, double to) {
        if (options.progress) {
            options.progress((from - values.front()) / (values.back() - values.front()));
        }
        return error_of_step(probe, finest, axis, {from, to}, options.threads);
    });
}

// Of those that may yet take finer steps, the axis along which the light in this cell is furthest
// off.
std::size_t most_to_blame(Probe& probe,
                          const MapAxes& finest,
                          const MapAxes& chosen,
                          const MapAxes& cell) {
    std::size_t most = kAxes.size();
    double error = -1.0;
    for (std::size_t a = 0; a < kAxes.size(); ++a) {
        const Axis axis = kAxes[a];
        if ((chosen.*axis).size() == (finest.*axis).size()) continue;
        const double found = error_of_step(probe, cell, axis, cell.*axis, 1);
        if (found > error) most = a, error = found;
    }
    return most;
}

std::size_t worst_of(const std::vector<Tally>& tallies) {
    const auto is_better = [](const Tally& a, const Tally& b) { return a.worst < b.worst; };
    return static_cast<std::size_t>(std::ranges::max_element(tallies, is_better) - tallies.begin());
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
    const std::scoped_lock lock(mutex_);
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

InterpolationError interpolation_error(const Rig& rig,
                                       const MapAxes& axes,
                                       double whole_limit,
                                       const MeasureOptions& options) {
    Probe probe(rig, axes);
    const Tally light = sum_of(light_tallies(probe, axes, options));
    return stated(light, whole_tallies(probe, axes, whole_limit, options), whole_limit);
}

ChosenAxes axes_for(const Rig& rig,
                    const MapAxes& finest,
                    double tolerance,
                    const MeasureOptions& options) {
    Probe probe(rig, finest);
    const auto moving =
        std::ranges::count_if(kAxes, [&](Axis axis) { return (finest.*axis).size() > 1; });
    std::array<double, kAxes.size()> shares{};
    shares.fill(tolerance / static_cast<double>(std::max<std::ptrdiff_t>(1, moving)));
    MapAxes chosen;
    for (std::size_t a = 0; a < kAxes.size(); ++a) {
        chosen.*kAxes[a] = chosen_values(probe, finest, kAxes[a], shares[a], options);
    }
    while (true) {
        const std::vector<Tally> light = light_tallies(probe, chosen, options);
        const std::size_t worst = worst_of(light);
        if (light[worst].worst <= tolerance || bin_count(chosen) == bin_count(finest)) {
            return {
                .axes = chosen,
                .interpolation = stated(
                    sum_of(light), whole_tallies(probe, chosen, tolerance, options), tolerance)};
        }
        const std::size_t a = most_to_blame(probe, finest, chosen, cell_of(chosen, worst));
        shares[a] *= kShrink;
        chosen.*kAxes[a] = shares[a] < kShareThatCounts * tolerance
                               ? finest.*kAxes[a]
                               : chosen_values(probe, finest, kAxes[a], shares[a], options);
    }
}

}  // namespace aphotic
