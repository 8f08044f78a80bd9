// SPDX-License-Identifier: BSD-3-Clause
//
// The family of light (spectral/light_family.h) that a rig's camera can see: every lamp's
// spectrum on the floor's material, and bare where the floor has a highlight, over the paths
// from the shortest to the longest.
//
// Paths run from each strobe to the floor that the image sees and on to the camera, in water,
// taken on a grid over the image. kPathRoom on both ends stands for what lies between the grid's
// points, for the size of emitters, and for the bending of other wavelengths in a port.
#pragma once

#include "scene_gen/rig.h"
#include "spectral/light_family.h"

namespace aphotic {

inline constexpr double kPathRoom = 1.05;

[[nodiscard]] LightFamily light_family(const Rig& rig);

}  // namespace aphotic
