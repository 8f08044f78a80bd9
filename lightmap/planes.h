// SPDX-License-Identifier: BSD-3-Clause
//
// A map in parts, for placing strobes: the light of a single strobe, or of one of its cones. Light
// adds up, so a part is the map of a rig that has nothing else, and the parts' sum is the map.
//
// A part's planes are named like OpenEXR layers: fore.R, or fore.collimated.R; its veil's
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

// A cone without a name, or with another cone's name, is numbered: fore.cone2.
[[nodiscard]] std::vector<RigPart> parts_by_cone(const Rig& rig);

// An InputError if two parts would have one name, such as a strobe "fore.collimated" next to a cone
// "collimated" of the strobe "fore".
void require_different_names(const std::vector<RigPart>& parts);

// For a map in a file: R, G, B, and veil.R, veil.G, veil.B if it has a veil.
[[nodiscard]] std::vector<std::string> plane_names(const std::string& layer, bool has_veil);

// The largest sample of each channel.
[[nodiscard]] std::array<float, kChannels> peaks_of(const Lightmap& map);

// Divides each channel by its peak, its veil too; a black one stays black.
void divide_by(const std::array<float, kChannels>& peaks, Lightmap& map);

}  // namespace aphotic
