// SPDX-License-Identifier: BSD-3-Clause
//
// What is implausible about a rig that the reader accepts: numbers in another unit than their
// key's, and strobes whose light no camera sees. The reader's own bounds only keep out what cannot
// be computed; these are what sleds, cameras and lamps in the sea are like.
//
// Every number of the rig's file is looked up in one table, usual.csv, by its key: what is usual,
// why, and the units that it may be in by mistake. It is doubted where it lies outside; then the
// unit is told that brings it nearest to what is typical. What no key alone tells is found from
// several: the field of view, tilts that are all below pi/2 degrees, weights that add up to 100,
// beam tables that end at pi, an absorption unlike any water's, and by geometry
//
//   a strobe is aimed above the horizon       axis . down < 0
//   its light misses the view                 I towards all of the floor in view < kNoLight max I
//
// Rigs with a scene of the user's are not asked of light: what stands there is not known here.
// A doubt is no proof: nothing is refused for it unless the user asks for that.
#pragma once

#include "rig/rig.h"
#include "spectral/curve_loader.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct Doubt {
    std::string key;   // as the reader's messages have it: strobe[1].position_m
    int line = 0;      // of the rig's file; 0: of no one line
    std::string what;  // the value, what is usual, why, and the unit that would make sense
};

// In the order of the rig's file, those about geometry last. Several of one key and one kind, as of
// all strobes, are one doubt. Of the sled and of the water's multiple, the rig's own numbers count,
// not its file's: commands set them.
[[nodiscard]] std::vector<Doubt> doubts_of(const Rig& rig);

// usual.csv: what is usual of each key.
[[nodiscard]] std::span<const BuiltinTable> usual_numbers();

// "rig.toml:12: strobe[1].position_m: found 500 ..."
[[nodiscard]] std::string in_words(const Doubt& doubt, std::string_view rig_file);

// Of a beam's largest intensity: what is fainter lights nothing.
inline constexpr double kNoLight = 1e-6;

// Whether the table has what is usual of a key, such as "strobe[].position_m" or "beam.*.fwhm_deg".
[[nodiscard]] bool is_judged_alone(std::string_view key);

}  // namespace aphotic
