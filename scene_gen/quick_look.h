// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic_quick.inc: the band and rig that plugin/include/aphotic.inc uses by default, so that
// plain povray renders a scene in true colours at once.
//
// Three wavelengths represent the channels, kQuickLambda_nm in red, green and blue: those fitted to
// HabCam over sand. Exposures make the lamps white, and the rig's own floor kQuickPeak at its
// brightest.
#pragma once

#include "rig/rig.h"
#include "scene_gen/sdl.h"

#include <filesystem>
#include <string>

namespace aphotic {

inline constexpr Channels kQuickLambda_nm{622.0, 550.0, 454.0};
inline constexpr double kQuickPeak = 0.9;

// For a rig, with its materials and all built-in reflectances and lamps by name; files are named
// relative to the rig's folder. Throws InputError if its range lacks one of the wavelengths.
[[nodiscard]] std::string quick_look_sdl(const Rig& rig, const std::filesystem::path& rig_folder);

}  // namespace aphotic
