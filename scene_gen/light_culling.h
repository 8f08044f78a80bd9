// SPDX-License-Identifier: BSD-3-Clause
//
// What a rig names or might hold and its scenes leave out, because it cannot change a pixel.
#pragma once

#include "rig/rig.h"

#include <string>
#include <vector>

namespace aphotic {

struct Omission {
    std::string what;
    std::string reason;
};

// is_user_scene: what stands in the water is not known here, so of strobes only what never shines
// is left out.
[[nodiscard]] std::vector<Omission> omissions(const Rig& rig, bool is_user_scene = false);

// Whether light of the strobe's beam, or of a part of it, can fall on floor or on an object that
// the image sees. The image is looked at in cells of a grid: a cell counts as lit when the beam may
// reach any of it, so that a yes may be wrong at the beam's edge and a no is not.
[[nodiscard]] bool lights_the_view(const Rig& rig, const Strobe& strobe, const Beam& beam);

}  // namespace aphotic
