// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/frame_groups.h"

#include "light/dispersion.h"

#include <numeric>

namespace aphotic {

std::vector<FrameGroup> frame_groups(const Rig& rig,
                                     std::span<const double> lambda_nm,
                                     int per_frame,
                                     double pixel_shift) {
    std::vector<FrameGroup> groups;
    for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
        const bool joins =
            !groups.empty() && groups.back().count < static_cast<std::size_t>(per_frame) &&
            corner_shift_px(rig, lambda_nm[groups.back().first], lambda_nm[i]) <= pixel_shift;
        if (!joins) groups.push_back({.first = i, .count = 0, .index_nm = 0.0});
        FrameGroup& group = groups.back();
        ++group.count;
        group.index_nm = std::midpoint(lambda_nm[group.first], lambda_nm[i]);
    }
    return groups;
}

}  // namespace aphotic
