// SPDX-License-Identifier: BSD-3-Clause
//
// The width of the narrowest light in a beam, so that samples leave no wider gaps:
//
//   a cone               2 gamma, its half angle's double; of a lobe cos^n at most 2 / sqrt(n)
//   a table              two steps of its angles where these are least, if a line of it is steep
//                        (steep_crease.h): a peak between its neighbours
//   an image by a lens   the angle of its shorter side
//
// A table without steep lines has no narrow light, and the width is pi. So it is for a uniform
// lamp, a cone of 90 degrees with n = 0.
#pragma once

#include "rig/beam/beam.h"

namespace aphotic {

[[nodiscard]] double narrowest_rad(const Beam& beam);

}  // namespace aphotic
