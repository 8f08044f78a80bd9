// SPDX-License-Identifier: BSD-3-Clause
//
// The veil's share of the signal in the middle of the image: V_c / S_c of each channel, 0 in water
// that does not scatter, 1 where no light from the floor arrives.
#pragma once

#include "spectral/sensor.h"

#include <fmt/format.h>

#include <array>
#include <string>

namespace aphotic {

using VeilShare = std::array<double, kChannels>;

// The pixel in an image's middle; for an even size, the one below and to the right of it.
[[nodiscard]] constexpr std::size_t middle_pixel(int width_px, int height_px) {
    const auto width = static_cast<std::size_t>(width_px);
    return static_cast<std::size_t>(height_px) / 2 * width + width / 2;
}

// A channel that sees nothing has no veil.
[[nodiscard]] constexpr double veil_share(double veil, double signal) {
    return signal > 0.0 ? veil / signal : 0.0;
}

[[nodiscard]] inline std::string veil_in_words(const VeilShare& share) {
    constexpr double kPercent = 100.0;
    return fmt::format(
        "veil in the middle of the image: {:.2g} % of R, {:.2g} % of G, {:.2g} % of B",
        kPercent * share[0],
        kPercent * share[1],
        kPercent * share[2]);
}

}  // namespace aphotic
