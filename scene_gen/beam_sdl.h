// SPDX-License-Identifier: BSD-3-Clause
//
// A beam in POV-Ray's language, for Aphotic_Strobe of plugin/include/aphotic.inc.
//
// Cones in water are spotlights: an array of {half angle in degrees, share of the lamp's flux} for
// each, with its exponent and the width of its soft edge in degrees, if it has these. Anything
// else, a pattern or any beam through a window, is a point light in a filter shell, whose
// transmittance is a function of the direction:
//
//   table    bilinear in its own angles, its nodes all in one spline: plane after plane
//   optics   the area of a disc within a rectangle
//   window   the direction in air, and the factor there
#pragma once

#include "rig/beam/beam.h"

#include <string>

namespace aphotic {

// The number of lights in the scene for each of the strobe's lamps.
[[nodiscard]] std::size_t light_count(const Beam& beam);

[[nodiscard]] bool needs_shell(const Beam& beam);

// The array, for a beam with lights and without a shell.
[[nodiscard]] std::string beam_sdl(const Beam& beam);

// For a beam with a shell: functions whose names begin with this one, the last of which has exactly
// this name, and the call that makes the beam from it.
[[nodiscard]] std::string pattern_functions_sdl(const Beam& beam, const std::string& name);
[[nodiscard]] std::string pattern_sdl(const Beam& beam, const std::string& name);

}  // namespace aphotic
