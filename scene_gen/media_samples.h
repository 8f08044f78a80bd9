// SPDX-License-Identifier: BSD-3-Clause
//
// What POV-Ray's media find of the veil along a ray, to know beforehand how far that is off.
//
// `method 2` with `intervals 1`, `jitter 0` and `samples N` is the midpoint rule of N samples, in
// each interval of the ray that is lit: of a spotlight what its cone cuts out, of a point light all
// of it, merged where they overlap. A cone's edge inside another's light would lie inside an
// interval and err by the first order of 1/N, smooth light by the second. So surfaces that nobody
// sees cut the ray at edges that are steps (plugin/include/aphotic.inc), unless the scene is a
// user's, where they would bend rays in glass. Steps of tables and images, and behind windows, are
// not cut.
//
// Objects and their shadows are left out.
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
    std::vector<PhaseFunction> lobes;  // in place of the water's phase functions
    int samples = 0;
    // A ray is cut at this length, twice, four times and so on, each piece sampled by itself, up to
    // the first from half of most_m on.
    double sight_m = 0.0;
    double most_m = 0.0;
    bool cuts_edges = true;  // of cones
};

// By strobe, the samples as nodes, weights by lobe. lamps: what stands for each strobe's emitter.
[[nodiscard]] std::vector<VeilNodes> media_samples(const Rig& rig,
                                                   std::span<const LampGrid> lamps,
                                                   const MediaSampling& sampling,
                                                   const WaterRay& ray,
                                                   double length_m);

}  // namespace aphotic
