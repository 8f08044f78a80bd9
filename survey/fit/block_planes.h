// SPDX-License-Identifier: BSD-3-Clause
//
// The floor of an image's blocks from its relief (light/relief.h): for each block the plane through
// the mean of its pixels' points, normal to the mean of their normals. For a relief that is a
// plane, it is that plane.
//
// A block has no plane (NaN) unless it shows one floor in one light: not if one of its pixels is
// unknown, if the floor jumps between two of them, or if relief hides one of them from a strobe.
// This is tested at the vertices of the shadows' mesh (light/relief_shadow.h), with point emitters.
#pragma once

#include "light/relief.h"
#include "rig/rig.h"
#include "survey/fit/fit_light.h"

#include <vector>

namespace aphotic {

[[nodiscard]] std::vector<Plane> block_planes(const Relief& relief,
                                              const FitPlaces& places,
                                              const Rig& rig);

}  // namespace aphotic
