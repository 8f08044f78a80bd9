// SPDX-License-Identifier: BSD-3-Clause
//
// The veil that POV-Ray's media compute along a ray, to determine its error beforehand.
//
// `method 2` with `intervals 1`, `jitter 0` and `samples N` is the midpoint rule of N samples, in
// each lit interval of the ray: for a spotlight the part within its cone, for a point light the
// whole ray, merged where they overlap. A cone's edge inside another's light would lie inside an
// interval, with an error of first order in 1/N; that of smooth light is second order. So invisible
// surfaces cut the ray at sharp edges (plugin/include/aphotic.inc), unless the scene is a user's,
// where they would bend rays in glass. Steps of tables and images, and behind windows, are not cut.
//
// Objects and their shadows are omitted.
#pragma once

#include "light/veil.h"
#include "rig/geometry.h"
#include "rig/rig.h"
#include "spectral/phase_function.h"

#include <cstddef>
#include <span>
#include <vector>

namespace aphotic {

struct MediaSampling {
    std::vector<PhaseFunction> lobes;  // instead of the water's phase functions
    int samples = 0;
    // A ray is cut at this length, twice, four times and so on, each piece sampled separately, up
    // to the first cut past half of most_m.
    double sight_m = 0.0;
    double most_m = 0.0;
    bool cuts_edges = true;  // of cones
};

// The samples as nodes, by strobe, with weights by lobe. lamps: the grid of each strobe's emitter.
[[nodiscard]] std::vector<VeilNodes> media_samples(const Rig& rig,
                                                   std::span<const LampGrid> lamps,
                                                   const MediaSampling& sampling,
                                                   const WaterRay& ray,
                                                   double length_m);

}  // namespace aphotic
