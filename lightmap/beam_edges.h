// SPDX-License-Identifier: BSD-3-Clause
//
// Where a strobe's beam ends sharply, over blocks of pixels: circles about its axis, and a rim that
// is none (rig/beam/beam.h).
#pragma once

#include "lightmap/direction_block.h"
#include "rig/beam/beam.h"
#include "rig/rig.h"

#include <cstdint>
#include <vector>

namespace aphotic {

struct RayBlock;

struct BeamEdges {
    std::vector<double> cosines;  // of the circles
    bool has_rim = false;
    Beam beam;
    BeamFrame frame;         // as the beam has it
    BeamFrame turned_frame;  // as directions are in it

    [[nodiscard]] std::size_t count() const { return cosines.size() + (has_rim ? 1 : 0); }
};

// A strobe without power has none.
[[nodiscard]] BeamEdges beam_edges(const Strobe& strobe);

// Whether light has steps at circles of windows alone, and no kinks in between: a row of it is
// worth fitting (row_fit.h). Cones have too many circles.
[[nodiscard]] bool is_smooth_between(const BeamEdges& edges);
// Whether none of these circles passes between the first of these directions and the last, along a
// line on which they are `count`. Of close ones it is not sure, and says no.
[[nodiscard]] bool is_between(const BeamEdges& edges,
                              const DirectionBlock& V,
                              std::size_t first,
                              std::size_t count);

// One more for each of kRowBlock pixels that see the floor within the edge of this number, less
// than count(). V with its sides.
void count_within(const BeamEdges& edges,
                  std::size_t edge,
                  const RayBlock& rays,
                  const DirectionBlock& V,
                  std::uint8_t* counts);

}  // namespace aphotic
