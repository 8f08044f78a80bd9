// SPDX-License-Identifier: BSD-3-Clause
//
// Everything in a rig that determines the paths of its light, whatever its colour: rigs of the same
// signature differ at most in lamp spectra, powers, the water's losses, reflectances and the
// sensor. By key, as text, with the fewest digits that read back to the same number.
//
// Composed of the parts' own signatures: beam, port, lens, and the water's index, which bends rays
// behind a port. Every field of the rig is listed, so that the code does not compile with a new
// field until it is decided whether frames depend on it.
#pragma once

#include "rig/rig.h"

#include <map>
#include <string>

namespace aphotic {

// By key: sled.altitude_m, camera.port, strobe 'NAME' and so on.
[[nodiscard]] std::map<std::string, std::string> geometry_signature(const Rig& rig);

}  // namespace aphotic
