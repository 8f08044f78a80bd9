// SPDX-License-Identifier: BSD-3-Clause
//
// Maps over altitude, pitch, roll and water: where a sled is between the bins of an atlas, and the
// map that its neighbours give.
//
//   S = exp( sum_i w_i ln S_i ),      w_i the product of 1 - t or t over the axes
//
// S_i  maps of the 2, 4, 8 or 16 bins about it (an axis of one value adds none)
// t    0 at the lower bin, 1 at the upper: of ln(altitude), of the angles and the water's multiple
//
// Light falls about as a power of altitude and as an exponential of water, so its logarithm is
// nearly straight where the light itself is not. Where a bin is black, the sum of w_i S_i stands
// in. An edge of a cone lies elsewhere in each bin; between two of them it is two half steps.
#pragma once

#include "lightmap/lightmap.h"
#include "rig/rig.h"

#include <span>
#include <string>
#include <vector>

namespace aphotic {

struct MapPoint {
    Sled sled;
    double water_multiple = 1.0;
};

// Each increasing and not empty.
struct MapAxes {
    std::vector<double> altitude_m;
    std::vector<double> pitch_rad;
    std::vector<double> roll_rad;
    std::vector<double> water_multiple;
};

[[nodiscard]] std::size_t bin_count(const MapAxes& axes);

// In the order of bins: altitude slowest, water fastest.
[[nodiscard]] std::vector<MapPoint> points_of(const MapAxes& axes);

struct Neighbour {
    std::size_t bin;
    double weight;  // over 0; their sum is 1
};

// Throws InputError outside the axes, which says which and what they cover. An axis of one value
// covers that alone.
[[nodiscard]] std::vector<Neighbour> neighbours_of(const MapAxes& axes, const MapPoint& point);

// The cells between bins, in the bins' own order. A cell has the two ends of its step on each axis,
// or the one value of an axis of one.
[[nodiscard]] std::size_t cell_count(const MapAxes& axes);
[[nodiscard]] MapAxes cell_of(const MapAxes& axes, std::size_t cell);

// The same axes with the middle of each step, in the axes' own measures.
[[nodiscard]] MapAxes with_middles(const MapAxes& axes);

[[nodiscard]] Lightmap blended(std::span<const Lightmap* const> maps,
                               std::span<const Neighbour> neighbours);

}  // namespace aphotic
