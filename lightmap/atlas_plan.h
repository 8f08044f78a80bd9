// SPDX-License-Identifier: BSD-3-Clause
//
// Which bins an atlas takes, and how far interpolation between them is from the truth.
//
// The error is measured: in the middle of cells, where it is largest, the map between the bins is
// held against the map that is computed there, on an image of the same field of view that is
// kProbe_px wide at most. It is that of the light without the cones' edges, each cone going on to
// 90 degrees. What an edge crosses on its way through the cell is no better than the step there,
// however fine the bins: such pixels are counted apart, and a tolerance says nothing of them.
#pragma once

#include "lightmap/map_axes.h"

#include <map>
#include <memory>
#include <vector>

namespace aphotic {

inline constexpr int kProbe_px = 136;
// Errors are relative to a sample, but to no less than this share of its channel's peak.
inline constexpr float kDimShare = 1e-3F;

// Maps of a rig at any point within the axes, tables made as waters come up.
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
    std::map<double, std::unique_ptr<LightmapMaker>> makers_;  // by the water's multiple
};

struct InterpolationError {
    double worst = 0.0;          // relative, of the light without edges
    double rms = 0.0;            // of the same
    double crossed_share = 0.0;  // of all pixels, by edges
};

// Over the middles of all cells.
[[nodiscard]] InterpolationError interpolation_error(const Rig& rig, const MapAxes& axes);

// Of the axes' values as few as keep the tolerance, always with both ends: along each axis, steps
// as wide as hold its share of it. Where even neighbouring values do not, all are kept.
[[nodiscard]] MapAxes axes_for(const Rig& rig, const MapAxes& finest, double tolerance);

}  // namespace aphotic
