// SPDX-License-Identifier: BSD-3-Clause
//
// What looks wrong about depth maps, by those of a few images. Each is said with the number that
// shows it, and only where no right maps do the same.
//
// unit        The altitudes that maps show, and those of the navigation, or the rig's own where
//             there is none, differ by over kOtherDepth times in the median.
// convention  Of maps along rays that are taken along the axis, even floors are bowls: told where
//             the other convention leaves under kOtherConvention of what maps are off one plane, in
//             the median over images that are even to kEvenFloor.
// images      The altitudes that maps show do not go with the navigation's: over images whose
//             altitudes differ (kSpreadOfAltitudes), their correlation is under kLikeAltitudes.
#pragma once

#include "survey/relief/floor_relief.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kOtherDepth = 5.0;
inline constexpr double kOtherConvention = 0.5;
inline constexpr double kEvenFloor = 0.1;
inline constexpr double kSpreadOfAltitudes = 0.02;
inline constexpr double kLikeAltitudes = 0.5;

// What one map tells.
struct DepthLook {
    double depth_m = 0.0;                   // the median along the axis
    std::optional<double> altitude_m = {};  // of the navigation, along the axis too
    Flatness flatness{};
    DepthIs taken{};
};
[[nodiscard]] DepthLook look_at_depth(const DepthMap& map,
                                      DepthIs is,
                                      const ReliefMapMaker& rays,
                                      const std::optional<Sled>& sled);

// Sentences. rig_altitude_m: where no image has one.
[[nodiscard]] std::vector<std::string> depth_doubts(std::span<const DepthLook> looks,
                                                    std::optional<double> rig_altitude_m);

}  // namespace aphotic
