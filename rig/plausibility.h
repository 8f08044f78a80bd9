// SPDX-License-Identifier: BSD-3-Clause
//
// Implausible values in a rig that the reader accepts: numbers in a unit other than their key's,
// and strobes whose light no camera sees. The reader's own bounds only exclude what cannot be
// computed; these describe sleds, cameras and lamps at sea.
//
// Every number of the rig's file is looked up by its key in one table, usual.csv, with the usual
// range, its reason, and the units in which the number may have been entered. A number outside is
// reported, with the unit that brings it closest to the typical value. Some doubts need several
// keys: the field of view, tilts that are all below pi/2 degrees, weights that add up to 100, beam
// tables that end at pi, an absorption unlike any water's, and from the geometry
//
//   a strobe is aimed above the horizon       axis . down < 0
//   its light misses the view                 I towards all floor in view < kNoLight max I
//
// Rigs with a user's scene are not checked for light, since the scene's contents are not known
// here. A doubt is not a proof: a rig is refused for it only if the user requests that.
#pragma once

#include "rig/rig.h"
#include "spectral/curve_loader.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct Doubt {
    std::string key;   // as in the reader's messages: strobe[1].position_m
    int line = 0;      // of the rig's file; 0 for no particular line
    std::string what;  // the value, the usual range, its reason, and a plausible unit
};

// In the order of the rig's file, those about geometry last. Several of the same key and kind, as
// for all strobes, are one doubt. For the sled and the water's multiple, the rig's current numbers
// count, not its file's, since commands set them.
[[nodiscard]] std::vector<Doubt> doubts_of(const Rig& rig);

// usual.csv: the usual range for each key.
[[nodiscard]] std::span<const BuiltinTable> usual_numbers();

// "rig.toml:12: strobe[1].position_m: found 500 ..."
[[nodiscard]] std::string in_words(const Doubt& doubt, std::string_view rig_file);

// Relative to a beam's largest intensity; fainter light is ignored.
inline constexpr double kNoLight = 1e-6;

// Whether the table has a key, such as "strobe[].position_m" or "beam.*.fwhm_deg".
[[nodiscard]] bool is_judged_alone(std::string_view key);

}  // namespace aphotic
