// SPDX-License-Identifier: BSD-3-Clause
//
// A measured table over blocks of directions (beam_light.h): the angles of rig/beam/beam_table.h,
// and I bilinear between the same nodes.
#pragma once

#include "lightmap/direction_block.h"
#include "rig/beam/beam_table.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace aphotic {

// Rising angles, and which two an angle is between without a search: even buckets tell the first
// node that may be below it, and so many comparisons with what follows the last.
struct NodeFinder {
    std::vector<double> nodes;
    std::vector<double> per_step;         // 1 / (from each to the next)
    std::vector<std::int32_t> by_bucket;  // the last node before the bucket
    std::vector<double> next;             // by node; of the last but one, infinity
    double buckets_per_rad = 0.0;
    int most_in_bucket = 0;
    bool is_even = false;  // the same step everywhere: buckets are the steps
};
[[nodiscard]] NodeFinder node_finder(const std::vector<double>& nodes);

struct TableEnds {
    double first = -std::numeric_limits<double>::infinity();
    double last = std::numeric_limits<double>::infinity();
};

// Where light ends. On which side of a step a direction is may be kept, and of an end at 0 it is
// its own.
struct TableLimits {
    TableEnds steps;
    TableEnds others;
};

struct TableLight {
    TableAngles angles = TableAngles::TypeC;
    NodeFinder vertical;
    NodeFinder horizontal;  // none where it is the same all about
    std::vector<double> intensity;
    TableLimits vertical_limits;
    TableLimits horizontal_limits;
};
[[nodiscard]] TableLight table_light(const BeamTable& table, double factor);

struct TableAnglesBlock {
    RowBlock<double> vertical;
    RowBlock<double> horizontal;
};

struct TableWork {
    RowBlock<double> is_within;  // the steps: 1 or 0
    RowBlock<double> is_lit;     // and the other ends
    TableAnglesBlock angles;
    DirectionBlock samples;
    TableAnglesBlock of_samples;
    RowBlock<double> length;
};

void look_into(const TableLight& light,
               const DirectionBlock& V,
               Edges edges,
               TableWork& work,
               RowBlock<double>& intensity);

}  // namespace aphotic
