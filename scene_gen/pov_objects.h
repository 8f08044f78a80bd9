// SPDX-License-Identifier: BSD-3-Clause
//
// The objects of a rig in POV-Ray's scene language: sphere, box, and mesh2 of flat triangles, in
// POV-Ray's frame (geometry.h), with pigment and finish as the floor has them. POV-Ray turns a
// normal towards the camera's ray, so a triangle is lit on the side that is seen. Every object
// casts shadows, which is POV-Ray's default, but for what lies within a millimetre of the lit point
// or of the lamp.
#pragma once

#include "scene_gen/rig.h"

#include <functional>
#include <string>

namespace aphotic {

// rgb: a reflectance at the frame's three wavelengths, such as "<0.2, 0.3, 0.4>".
[[nodiscard]] std::string pov_objects(const Rig& rig,
                                      const std::function<std::string(const Spectrum&)>& rgb);

}  // namespace aphotic
