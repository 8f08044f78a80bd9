// SPDX-License-Identifier: BSD-3-Clause
//
// The camera's signals R, G and B at every pixel, linear.
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace aphotic {

inline constexpr int kChannels = 3;
inline constexpr std::array<std::string_view, kChannels> kChannelNames{"R", "G", "B"};

// Planar: all rows of R, then of G, then of B.
struct CameraImage {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> samples{};
};

}  // namespace aphotic
