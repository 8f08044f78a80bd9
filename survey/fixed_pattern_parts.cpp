// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fixed_pattern_parts.h"

#include "image/preview.h"
#include "report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aphotic {
namespace {

constexpr int kPicture_px = 320;

std::uint32_t colour_of(float off) {
    constexpr std::uint32_t kGrey = 0xC0C0C0;
    if (std::isnan(off)) return kGrey;
    const double share = std::clamp(static_cast<double>(off) / kShownPattern, -1.0, 1.0);
    const auto faded = static_cast<std::uint32_t>(std::lround(255.0 * (1.0 - std::abs(share))));
    const std::uint32_t red = share > 0.0 ? 255U : faded;
    const std::uint32_t blue = share > 0.0 ? faded : 255U;
    return red << 16U | faded << 8U | blue;
}

}  // namespace

std::vector<PagePart> parts_of(const FixedPattern& pattern, std::size_t across, PlaneSize image) {
    if (pattern.logarithm.empty()) return {};
    const std::size_t down = pattern.logarithm.size() / across;
    const auto width_px = static_cast<std::size_t>(kPicture_px);
    const std::size_t height_px =
        std::max<std::size_t>(1,
                              width_px * static_cast<std::size_t>(image.height_px) /
                                  static_cast<std::size_t>(image.width_px));
    std::vector<std::uint32_t> colours;
    for (std::size_t row = 0; row < height_px; ++row)
        for (std::size_t column = 0; column < width_px; ++column)
            colours.push_back(colour_of(
                pattern.logarithm[row * down / height_px * across + column * across / width_px]));
    const int height = static_cast<int>(height_px);
    PageFigures figures{.figures = {{.pictures = {{.bytes = png_of(colours, kPicture_px, height),
                                                   .width_px = kPicture_px,
                                                   .height_px = height,
                                                   .words = "fixed pattern"}},
                                     .caption = "fixed pattern"}},
                        .are_small = true};
    return {fmt::format("What stays in place from image to image: {}. Red: brighter than expected, "
                        "blue: darker, in full colour at {:.0f} %.",
                        words_of(pattern),
                        100.0 * kShownPattern),
            std::move(figures)};
}

}  // namespace aphotic
