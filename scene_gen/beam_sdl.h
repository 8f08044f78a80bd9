// SPDX-License-Identifier: BSD-3-Clause
//
// A beam in POV-Ray's words: the array that Aphotic_Strobe of plugin/include/aphotic.inc makes
// spotlights of, {half angle in degrees, share of the lamp's flux} for each cone, and its exponent
// where one has another than 1.
#pragma once

#include "rig/beam.h"

#include <string>

namespace aphotic {

// Lights of the scene, for each of the strobe's lamps.
[[nodiscard]] std::size_t light_count(const Beam& beam);

// Of a beam with lights.
[[nodiscard]] std::string beam_sdl(const Beam& beam);

}  // namespace aphotic
