// SPDX-License-Identifier: BSD-3-Clause
//
// The floor of an image's blocks by its relief (light/relief.h): of each block the plane through
// the mean of its pixels' points, normal to the mean of their normals. Of a relief that is a plane
// it is that plane.
//
// A block has no plane, NaN, where it is not of one floor in one light: where a pixel of it is
// unknown, where the floor jumps between two of them, or where relief hides one of them from a
// strobe. This is looked for at the vertices of the shadows' mesh (light/relief_shadow.h), the
// emitter taken for a point.
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
