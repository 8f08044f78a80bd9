// SPDX-License-Identifier: BSD-3-Clause
//
// What the frames of a rig depend on, part by part, in words and numbers: its geometry. Sources of
// light, materials, water and sensor are none of it, for weights can change those
// (scene_gen/reweighting.h); but behind a port the water's indices are, for they bend rays.
//
// Numbers are as short as reads back to the same. Every field of the rig is visited, so that a new
// one does not compile before it is said whether frames depend on it.
#pragma once

#include "rig/rig.h"

#include <map>
#include <string>

namespace aphotic {

// By key: sled.altitude_m, camera.port, strobe 'NAME' and so on.
[[nodiscard]] std::map<std::string, std::string> geometry_signature(const Rig& rig);

}  // namespace aphotic
