// SPDX-License-Identifier: BSD-3-Clause
//
// The width of the narrowest light in a beam, which the spacing of samples must not exceed:
//
//   a cone               its width at half of its light, for a sharp one twice its half angle; for
//                        a lobe cos^n at most 2 / sqrt(n)
//   a table              two steps of its angles where they are smallest, if one of its lines is
//                        steep (steep_crease.h): a peak between two neighbours
//   an image by a lens   the angle of its shorter side
//
// A table without steep lines has no narrow light, and its width is pi. The same holds for a
// uniform lamp, a cone of 90 degrees with n = 0.
#pragma once

#include "rig/beam/beam.h"

namespace aphotic {

[[nodiscard]] double narrowest_rad(const Beam& beam);

}  // namespace aphotic
