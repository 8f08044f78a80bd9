// SPDX-License-Identifier: BSD-3-Clause
//
// A rig as macros for POV-Ray, in the terms of plugin/include/aphotic.inc:
//
//   Aphotic_Rig_Camera ()    its camera and port
//   Aphotic_Rig_Strobes ()   its strobes
//   Aphotic_Rig ()           both, and the water
//   Aphotic_Rig_Seafloor ()  its floor
//   Aphotic_Rig_Objects ()   its objects
//   Aphotic_Rig_Beam (I)     its beams, in the order of Aphotic_Beam_Names: see SceneAuthor
//
// in the sled's frame, in the scene's unit.
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"
#include "scene_gen/band_sdl.h"

#include <span>
#include <string>
#include <vector>

namespace aphotic {

// One strobe in the scene.
struct StrobeInScene {
    Beam beam;       // the part of its light in view, if any
    LampGrid lamps;  // of its emitter
};

// A user's scene may call any of the rig's beams by name, with Aphotic_Beam.
enum class SceneAuthor { Ours, User };

// lamps and reflectances: the names of the rig's spectra in the scene's band.
[[nodiscard]] std::string rig_sdl(const Rig& rig,
                                  const std::vector<StrobeInScene>& strobes,
                                  std::span<const NamedSpectrum> lamps,
                                  std::span<const NamedSpectrum> reflectances,
                                  SceneAuthor author);

}  // namespace aphotic
