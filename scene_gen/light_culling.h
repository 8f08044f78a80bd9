// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of a rig that its scenes omit, because they cannot change a pixel.
#pragma once

#include "rig/rig.h"

#include <string>
#include <vector>

namespace aphotic {

struct Omission {
    std::string what;
    std::string reason;
};

// is_user_scene: its contents are not known here, so only strobes that never shine are omitted.
[[nodiscard]] std::vector<Omission> omissions(const Rig& rig, bool is_user_scene = false);

// Whether light of the strobe's beam, or of a part of it, can fall on floor or on an object that
// the image sees. The image is examined in grid cells: a cell counts as lit if the beam may reach
// any of it, so true may be wrong at the beam's edge and false is certain.
[[nodiscard]] bool lights_the_view(const Rig& rig, const Strobe& strobe, const Beam& beam);

}  // namespace aphotic
