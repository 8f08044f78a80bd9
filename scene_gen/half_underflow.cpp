// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/half_underflow.h"

#include "base/error.h"
#include "image/frame_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aphotic {

void require_light_that_counts(std::span<const PlannedWavelength> wavelengths, double frame_error) {
    constexpr double kHeldLog2 = -8.0;  // also a pixel 64 times darker has all of its digits
    const auto peak_log2 = [](const PlannedWavelength& w) {
        return std::log2(w.radiance_bound) + w.exposure_log2;
    };
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto signal = [c](const PlannedWavelength& w) {
            return std::abs(w.weight[c]) * w.radiance_bound;
        };
        double most = 0.0;
        for (const PlannedWavelength& w : wavelengths) most = std::max(most, signal(w));
        const auto counts = [&](const PlannedWavelength& w) {
            return signal(w) > frame_error * most;
        };
        if (std::ranges::none_of(wavelengths, [&](const PlannedWavelength& w) {
                return counts(w) && peak_log2(w) >= kHeldLog2;
            }))
            continue;
        for (const PlannedWavelength& w : wavelengths) {
            if (!counts(w) || peak_log2(w) >= kSmallestNormalHalfLog2) continue;
            throw InputError(fmt::format(
                "found light of at most {:.1e} at {} nm, fainter than frames hold, which counts in "
                "{} by a weight of {:.1e}; allowed: wavelengths that frames hold, or that count "
                "for nothing",
                w.radiance_bound,
                w.lambda_nm,
                kChannelNames[c],
                w.weight[c]));
        }
    }
}

}  // namespace aphotic
