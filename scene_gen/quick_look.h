// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic_quick.inc: the band and the rig that plugin/include/aphotic.inc takes when nobody gives
// it another, so that plain povray shows a scene in true colours at once.
//
// Three wavelengths stand for the channels, kQuickLambda_nm in red, green and blue: those that fit
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

// Of a rig, with its materials and all built-in reflectances and lamps by name; files are called as
// they lie from the rig's folder. Throws InputError when its range lacks one of the wavelengths.
[[nodiscard]] std::string quick_look_sdl(const Rig& rig, const std::filesystem::path& rig_folder);

}  // namespace aphotic
