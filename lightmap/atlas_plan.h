// SPDX-License-Identifier: BSD-3-Clause
//
// Which bins an atlas takes, and how far interpolation between them is from the truth.
//
// The error is measured: in the middles of all edges, faces and insides of the cells between bins,
// the map between the bins is held against the map that is computed there, on an image of the same
// field of view that is kProbe_px wide at most. It is the largest of what is found, not a bound: on
// its way from bin to bin light is mostly furthest off in the middle, but of an axis the error may
// peak somewhat aside of it, and errors of several axes may have opposite signs, and so be less
// inside a cell than on its edges.
//
// In water that scatters it is that of the sum, floor and veil, which are interpolated apart.
//
// It is that of the light without the beams' edges, each cone going on to 90 degrees. What an edge
// crosses on its way through the cell is no better than the step there, however fine the bins: a
// tolerance says nothing of it. How much that is of the whole maps is measured apart, in the
// middles of cells, kWholeCells of them at most, spread evenly.
#pragma once

#include "lightmap/map_axes.h"

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace aphotic {

inline constexpr int kProbe_px = 68;
// Errors are relative to a sample, but to no less than this share of its channel's peak.
inline constexpr float kDimShare = 1e-3F;

// Maps of a rig at any point within the axes, tables made as waters come up. For several threads.
class MapSource {
  public:
    MapSource(const Rig& rig, const MapAxes& within, const LightmapOptions& options);

    [[nodiscard]] Lightmap map(const MapPoint& point);
    // See LightmapMaker.
    [[nodiscard]] std::vector<double> cones(const MapPoint& point);
    [[nodiscard]] Lightmap rows(const MapPoint& point, int first_row, int count);

  private:
    [[nodiscard]] const LightmapMaker& maker(double water_multiple);

    Rig rig_;
    std::vector<Sled> ends_;
    LightmapOptions options_;
    std::mutex mutex_;                                         // of the makers
    std::map<double, std::unique_ptr<LightmapMaker>> makers_;  // by the water's multiple
};

struct InterpolationError {
    double worst = 0.0;  // relative, of the light without edges
    double rms = 0.0;    // of the same
    // Of the maps with their edges, in the middles of so many cells. Errors are relative to the
    // larger of both samples, so that light which only one of them has counts 1.
    std::size_t whole_cells = 0;
    double crossed_share = 0.0;  // of all pixels, by edges on the way from a bin
    double whole_rms = 0.0;
    double whole_limit = 0.0;  // the tolerance, or kWholeLimit where none is given,
    double whole_over = 0.0;   // and the share of samples that are off by more
};

inline constexpr double kWholeLimit = 0.01;
inline constexpr std::size_t kWholeCells = 512;

// How to measure. No result depends on it.
struct MeasureOptions {
    int threads = 1;
    std::function<void(double)> progress = {};  // share of the work; it may begin anew
};

[[nodiscard]] InterpolationError interpolation_error(const Rig& rig,
                                                     const MapAxes& axes,
                                                     double whole_limit = kWholeLimit,
                                                     const MeasureOptions& options = {});

struct ChosenAxes {
    MapAxes axes;
    InterpolationError interpolation;  // of these
};

// Of the axes' values as few as are found to keep the tolerance, always with both ends: along each
// axis, steps as wide as hold its share of it, where the other axes end. While the choice as a
// whole is measured over the tolerance, the axis that is most to blame takes finer steps. When no
// choice holds, all values are kept: then these do not hold it either.
[[nodiscard]] ChosenAxes axes_for(const Rig& rig,
                                  const MapAxes& finest,
                                  double tolerance,
                                  const MeasureOptions& options = {});

}  // namespace aphotic
