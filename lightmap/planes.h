// SPDX-License-Identifier: BSD-3-Clause
//
// A map in parts, for people who place strobes: what one strobe alone gives, or one cone of it.
// Light adds up, so a part is the map of a rig that has nothing else, and the parts' sum is the
// map.
//
// A part's planes are named as layers of OpenEXR are: fore.R, or fore.collimated.R; its veil's
// fore.veil.R.
#pragma once

#include "lightmap/lightmap.h"

#include <string>
#include <vector>

namespace aphotic {

struct RigPart {
    std::string name;
    Rig rig;
};

[[nodiscard]] std::vector<RigPart> parts_by_strobe(const Rig& rig);

// A cone that its beam gives no name, or one that another has, is numbered: fore.cone2.
[[nodiscard]] std::vector<RigPart> parts_by_cone(const Rig& rig);

// An InputError when two parts would have one name, as a strobe "fore.collimated" beside a cone
// "collimated" of the strobe "fore".
void require_different_names(const std::vector<RigPart>& parts);

// Of a map in a file: R, G, B, and veil.R, veil.G, veil.B where it has a veil.
[[nodiscard]] std::vector<std::string> plane_names(const std::string& layer, bool has_veil);

// The largest sample of each channel.
[[nodiscard]] std::array<float, kChannels> peaks_of(const Lightmap& map);

// Divides each channel by its peak, its veil too; one that is black stays so.
void divide_by(const std::array<float, kChannels>& peaks, Lightmap& map);

}  // namespace aphotic
