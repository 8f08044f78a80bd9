// SPDX-License-Identifier: BSD-3-Clause
//
// The light of a rig's lamps on a relief, at every pixel: the sum of floor_light.h, of which each
// pixel has a plane of its own, the one that touches the relief where it looks.
//
// No light of a lamp comes to a place that turns away from it, or that the relief hides from it
// (relief_shadow.h). Shadows are looked for at every n-th pixel as the mesh has them, and at each
// pixel between places that disagree. Where points and normals of a cell of kReliefCell_px are
// those of its corners, interpolated, to kReliefOff of the distance, so is the light, if it is
// right to kReliefError in the middle; elsewhere every pixel has its own sum.
#pragma once

#include "light/floor_light.h"
#include "light/path_range.h"
#include "light/relief.h"

#include <cstdint>
#include <vector>

namespace aphotic {

// That a table of the signal has for a relief of any shape. Light on other ways is left out.
inline constexpr PathRange kReliefPaths{.shortest_m = 0.02, .longest_m = 100.0};

inline constexpr int kReliefCell_px = 4;
inline constexpr float kReliefOff = 2e-5F;
inline constexpr float kReliefError = 5e-5F;

struct ReliefLight {
    std::vector<float> samples;  // R, G, B, one after another; 0 where nothing is known
    // By pixel: which lamps it is hidden from, and within which edges of their beams it is. Where
    // neighbours have another, an edge or a shadow's border passes between them.
    std::vector<std::uint32_t> seen;
};

[[nodiscard]] ReliefLight relief_light(const Rig& rig,
                                       const FloorLight& light,
                                       const Relief& relief,
                                       int threads);

}  // namespace aphotic
