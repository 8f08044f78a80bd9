// SPDX-License-Identifier: BSD-3-Clause
//
// The objects of a rig as a macro for POV-Ray, Aphotic_Rig_Objects (): sphere, box, and mesh2 of
// flat triangles, in POV-Ray's frame (geometry.h), with pigment and finish as the floor has them.
// POV-Ray turns a normal towards the camera's ray, so a triangle is lit on the side that is seen.
// Every object casts shadows, which is POV-Ray's default, but for what lies within a millimetre of
// the lit point or of the lamp.
#pragma once

#include "rig/rig.h"
#include "scene_gen/band_sdl.h"

#include <span>
#include <string>

namespace aphotic {

// reflectances: the names of the objects' spectra, as the scene's band has them.
[[nodiscard]] std::string pov_objects(const Rig& rig, std::span<const NamedSpectrum> reflectances);

}  // namespace aphotic
