// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/light_paths.h"

#include "scene_gen/geometry.h"

#include <algorithm>
#include <limits>

namespace aphotic {

LightFamily light_family(const Rig& rig) {
    constexpr std::size_t kGrid = 33;
    LightFamily family{.sources = {},
                       .water = rig.water,
                       .shortest_path_m = std::numeric_limits<double>::infinity(),
                       .longest_path_m = 0.0};
    for (const Strobe& strobe : rig.strobes) {
        family.sources.push_back({strobe.spectrum, rig.seafloor.reflectance});
        if (rig.seafloor.phong > 0.0) family.sources.push_back({strobe.spectrum});
    }
    for (const auto& sample : floor_samples(rig, kGrid)) {
        if (!sample) continue;
        for (const Strobe& strobe : rig.strobes) {
            const double path_m =
                sample->camera_leg_m + (sample->point_m - strobe.position_m).norm();
            family.shortest_path_m = std::min(family.shortest_path_m, path_m / kPathRoom);
            family.longest_path_m = std::max(family.longest_path_m, path_m * kPathRoom);
        }
    }
    // No floor in view: no light, of no path.
    if (family.longest_path_m == 0.0) family.shortest_path_m = 0.0;
    return family;
}

}  // namespace aphotic
