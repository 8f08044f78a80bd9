// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/evenness.h"

#include "image/camera_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace aphotic {

LightFigures worst_of(const LightFigures& a, const LightFigures& b) {
    return {.evenness = std::min(a.evenness, b.evenness),
            .diversity = std::min(a.diversity, b.diversity),
            .coverage = std::min(a.coverage, b.coverage),
            .signal_to_noise = std::min(a.signal_to_noise, b.signal_to_noise)};
}

LightFigures figures_of_plane(std::span<const float> floor,
                              std::span<const float> veil,
                              double level) {
    const auto [least, most] = std::ranges::minmax(floor);
    if (most <= 0.0F) return {};
    const double enough = level * static_cast<double>(most);
    double sum = 0.0;
    std::size_t covered = 0;
    double signal_to_noise = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < floor.size(); ++i) {
        const double g = floor[i];
        const double v = veil.empty() ? 0.0 : veil[i];
        sum += g;
        covered += g >= enough ? 1 : 0;
        signal_to_noise = std::min(signal_to_noise, g > 0.0 ? g / std::sqrt(g + v) : 0.0);
    }
    const auto count = static_cast<double>(floor.size());
    return {.evenness = static_cast<double>(least) * count / sum,
            .diversity = static_cast<double>(least) / static_cast<double>(most),
            .coverage = static_cast<double>(covered) / count,
            .signal_to_noise = signal_to_noise};
}

LightFigures figures_of(const Lightmap& map, double level) {
    const std::size_t plane = map.samples.size() / kChannels;
    std::optional<LightFigures> worst;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto channel = [&](const std::vector<float>& all) {
            return all.empty() ? std::span<const float>()
                               : std::span(all).subspan(c * plane, plane);
        };
        const std::span<const float> floor = channel(map.samples);
        if (std::ranges::none_of(floor, [](float g) { return g > 0.0F; })) continue;
        const LightFigures figures = figures_of_plane(floor, channel(map.veil), level);
        worst = worst ? worst_of(*worst, figures) : figures;
    }
    return worst.value_or(LightFigures{});
}

}  // namespace aphotic
