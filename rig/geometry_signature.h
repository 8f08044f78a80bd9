// SPDX-License-Identifier: BSD-3-Clause
//
// All of a rig that decides where its light goes, whatever its colour: rigs of the same signature
// differ in lamp spectra, powers, the water's losses, reflectances and the sensor at most. By key,
// as words and numbers, each as short as reads back to the same.
//
// Put together of the parts' own signatures: beam, port, lens, the water's index, which bends rays
// behind a port. Every field of the rig is visited, so that a new one does not compile before it is
// said whether frames depend on it.
#pragma once

#include "rig/rig.h"

#include <map>
#include <string>

namespace aphotic {

// By key: sled.altitude_m, camera.port, strobe 'NAME' and so on.
[[nodiscard]] std::map<std::string, std::string> geometry_signature(const Rig& rig);

}  // namespace aphotic
