// SPDX-License-Identifier: BSD-3-Clause
//
// The light of each strobe of a rig where an image was taken: in cells (survey/dropouts.h), from
// small lightmaps, to detect which strobes fired; and for those that did, at every pixel. The light
// of strobes adds up, so that of one strobe is the lightmap of a rig that has no other.
#pragma once

#include "lightmap/lightmap.h"
#include "rig/rig.h"
#include "survey/dropouts.h"
#include "survey/light_at.h"
#include "survey/relief/floor_relief.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct StrobesAt {
    std::vector<std::string> names{};
    // These are called from several threads.
    std::function<std::vector<CellPlane>(const Sled& sled)> cells{};  // by strobe; empty: unknown
    // Without the strobes whose bits are set, at most all but one.
    std::function<Lightmap(const Sled& sled, std::uint64_t out)> map_without{};
    // The same for images with depth maps.
    std::function<std::vector<CellPlane>(
        const DepthMap&, const DepthMaps&, const std::optional<Sled>&)>
        relief_cells{};
    std::function<std::shared_ptr<const ReliefMapMaker>(std::uint64_t out)> relief_without{};
};

// For the poses of these images, as in light_of_rig(). Empty for a rig of more than kMostStrobes.
[[nodiscard]] StrobesAt strobes_of_rig(const Rig& rig,
                                       const std::optional<Navigation>& navigation,
                                       const std::vector<ImageFile>& files,
                                       bool has_veil = true,
                                       double veil_tolerance = kVeilOfCorrection,
                                       bool has_relief = false);

}  // namespace aphotic
