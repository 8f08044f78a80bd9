// SPDX-License-Identifier: BSD-3-Clause
//
// The water of a rig file, [water], is one of
//
//   type                       a natural water's a and b, by a built-in name or from a table
//   chlorophyll_mg_m3          with cdom_440_per_m and particles: case-1 water
//   absorption, scattering     tables of a and b; or absorption and attenuation, of c = a + b
//   absorption                 water that does not scatter
//
// each with phase, multiple, uniform_loss_per_m, salinity_psu, temperature_c.
#pragma once

#include "rig/file/rig_files.h"
#include "rig/file/section.h"
#include "spectral/water.h"

namespace aphotic {

[[nodiscard]] Water read_water(Section section, RigFiles& files);

}  // namespace aphotic
