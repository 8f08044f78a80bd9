// SPDX-License-Identifier: BSD-3-Clause
//
// The light of a rig's lamps on a relief, at every pixel: the sum of floor_light.h, with a plane
// for each pixel, the relief's tangent plane at its point.
//
// A lamp gives no light to a place that faces away from it, or from which the relief hides it
// (relief_shadow.h). Shadows are traced at every nth pixel, as in the mesh, and at each pixel
// between places that disagree. If the points and normals of a cell of kReliefCell_px agree with
// those interpolated from its corners to kReliefOff of the distance, its light is interpolated as
// well, provided that this is accurate to kReliefError in the middle; elsewhere every pixel has its
// own sum.
#pragma once

#include "light/floor_light.h"
#include "light/path_range.h"
#include "light/relief.h"

#include <cstdint>
#include <vector>

namespace aphotic {

// The range of a signal's table for a relief of any shape. Light on longer or shorter paths is
// omitted.
inline constexpr PathRange kReliefPaths{.shortest_m = 0.02, .longest_m = 100.0};

inline constexpr int kReliefCell_px = 4;
inline constexpr float kReliefOff = 2e-5F;
inline constexpr float kReliefError = 5e-5F;

struct ReliefLight {
    std::vector<float> samples;  // R, G, B, one after another; 0 where unknown
    // By pixel: which lamps are hidden from it, and which of their beams' edges enclose it. Where
    // neighbours differ, an edge or a shadow's border passes between them.
    std::vector<std::uint32_t> seen;
};

[[nodiscard]] ReliefLight relief_light(const Rig& rig,
                                       const FloorLight& light,
                                       const Relief& relief,
                                       int threads);

}  // namespace aphotic
