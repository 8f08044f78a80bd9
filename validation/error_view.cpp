// SPDX-License-Identifier: BSD-3-Clause
#include "validation/error_view.h"

#include "image/preview.h"
#include "report/html.h"
#include "report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace aphotic {
namespace {

int blocks(int pixels, int side) {
    return (pixels + side - 1) / side;
}

// Calls visit(index of the block, index of the sample) for every sample.
template <typename Visit>
void for_each_in_blocks(int width_px, int height_px, int side_px, const Visit& visit) {
    const auto width = static_cast<std::size_t>(width_px);
    const auto height = static_cast<std::size_t>(height_px);
    const auto side = static_cast<std::size_t>(side_px);
    const std::size_t across = (width + side - 1) / side;
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t column = 0; column < width; ++column)
            visit(row / side * across + column / side, row * width + column);
    }
}

std::uint32_t colour_of(double e, double scale) {
    constexpr int kMost = (kColourSteps - 1) / 2;
    const double step = std::clamp(e / scale, -1.0, 1.0) * kMost;
    return error_colour(static_cast<int>(std::lround(step)));
}

// Images that are mostly equal determine no scale.
double map_scale(const Comparison& comparison) {
    for (const double end : {comparison.percentile_999, comparison.bound, comparison.max_error}) {
        if (end > 0.0 && std::isfinite(end)) return round_up(end);
    }
    return 1e-3;
}

std::optional<std::pair<double, double>> worst_place(const MappedErrors& mapped) {
    const Comparison& comparison = *mapped.comparison;
    if (comparison.max_error == 0.0) return std::nullopt;
    const double height_px = static_cast<double>(mapped.errors.size()) / mapped.width_px;
    return std::pair((comparison.column + 0.5) / mapped.width_px,
                     (comparison.row + 0.5) / height_px);
}

PageLegend map_legend(const MappedErrors& mapped, double end) {
    const Comparison& comparison = *mapped.comparison;
    const auto key = [&](double share, std::string words) {
        const auto step = std::lround(share * (kColourSteps - 1) / 2);
        return swatch_key(error_colour(static_cast<int>(step)), std::move(words));
    };
    PageLegend legend{
        key(-1.0, fmt::format("−{}: {} is darker", scientific(end), mapped.image_name)),
        key(-0.5, fmt::format("−{}", scientific(0.5 * end))),
        key(0.0, "0"),
        key(0.5, fmt::format("+{}", scientific(0.5 * end))),
        key(1.0, fmt::format("+{}: {} is brighter", scientific(end), mapped.image_name))};
    if (!mapped.set_apart.empty()) legend.push_back(swatch_key(kEdgeColour, mapped.set_apart));
    if (comparison.not_finite > 0) {
        legend.push_back(swatch_key(
            kNotFiniteColour, "not finite: " + grouped_count(comparison.not_finite, "sample")));
    }
    if (comparison.max_error > 0.0) {
        legend.push_back({"◯",
                          fmt::format("the largest, {} at column {}, row {}",
                                      scientific(comparison.max_error),
                                      comparison.column,
                                      comparison.row)});
    }
    return legend;
}

std::string map_in_words(const MappedErrors& mapped, const ErrorMap& map, double end) {
    const auto beyond =
        std::ranges::count_if(mapped.errors, [&](float e) { return std::abs(e) > end; });
    std::string words = fmt::format("The colours run from −{0} to +{0}", scientific(end));
    words += beyond == 0 ? "; no pixel is beyond."
                         : fmt::format("; {} beyond, shown in the end’s colour.",
                                       grouped_count(static_cast<std::size_t>(beyond), "pixel"));
    if (map.side > 1) {
        words += fmt::format(
            " Each point of the map shows the largest |e| of {0} × {0} pixels, with its sign.",
            map.side);
    }
    return words;
}

SvgAxis value_axis(const Profile& profile) {
    ValueRange range{.least = 0.0, .most = 0.0};
    range.include(profile.image);
    range.include(profile.reference);
    if (range.most == range.least) range.most = range.least + 1.0;
    return linear_axis(range.least, range.most + 0.07 * (range.most - range.least), 5);
}

// Includes the bound if it is not far from the errors.
SvgAxis error_axis(std::span<const Profile> profiles) {
    constexpr double kNear = 4.0;
    ValueRange errors{.least = 0.0, .most = 0.0};
    double bound = 0.0;
    for (const Profile& profile : profiles) {
        errors.include(profile.errors);
        bound = std::max(bound, profile.bound);
    }
    double end = 1.05 * std::max(errors.most, -errors.least);
    if (bound < kNear * end || end == 0.0) end = std::max(bound, end);
    end = end > 0.0 ? round_up(end) : 1.0;
    return linear_axis(-end, end, 4);
}

// R, G and B have their own colours; other channels are drawn in ink.
std::string tone_of(const std::string& channel) {
    const auto found = std::ranges::find(kChannelNames, channel);
    if (found == kChannelNames.end()) return "";
    return svg_tone(kChannelTones[static_cast<std::size_t>(found - kChannelNames.begin())]);
}

}  // namespace

int block_side(int width_px, int height_px) {
    return blocks(std::max(width_px, height_px), kLargestPicture_px);
}

std::vector<double> block_means(std::span<const float> samples,
                                int width_px,
                                int side,
                                std::span<const unsigned char> marks) {
    const int height_px = static_cast<int>(samples.size()) / width_px;
    const auto size = static_cast<std::size_t>(blocks(width_px, side)) *
                      static_cast<std::size_t>(blocks(height_px, side));
    std::vector<double> means(size, 0.0);
    std::vector<double> counts(size, 0.0);
    for_each_in_blocks(width_px, height_px, side, [&](std::size_t block, std::size_t i) {
        if (!marks.empty() && marks[i] == kUnobserved) return;
        means[block] += samples[i];
        counts[block] += 1.0;
    });
    for (std::size_t block = 0; block < size; ++block) means[block] /= counts[block];
    return means;
}

CameraImage block_means(const CameraImage& image, int side) {
    CameraImage result{.width_px = blocks(image.width_px, side),
                       .height_px = blocks(image.height_px, side),
                       .samples = {}};
    const std::size_t pixels = image.samples.size() / kChannels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto plane = std::span(image.samples).subspan(c * pixels, pixels);
        for (const double mean : block_means(plane, image.width_px, side))
            result.samples.push_back(static_cast<float>(mean));
    }
    return result;
}

std::uint32_t colour_between(std::span<const std::uint32_t> stops, double share) {
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
    const auto stop = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    std::uint32_t colour = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const double from = stops[stop] >> shift & 0xFFU;
        const double to = stops[stop + 1] >> shift & 0xFFU;
        const double level = std::lerp(from, to, place - static_cast<double>(stop));
        colour |= static_cast<std::uint32_t>(std::lround(level)) << shift;
    }
    return colour;
}

// Through a paler tone between white and the ends, so that small errors show too.
std::uint32_t error_colour(int step) {
    static constexpr std::array<std::uint32_t, 4> kBlues{0xFBFAF8, 0xBBD6EA, 0x3F86BD, 0x0B3166};
    static constexpr std::array<std::uint32_t, 4> kReds{0xFBFAF8, 0xF6CDB6, 0xD4594A, 0x6E0A1E};
    return colour_between(step < 0 ? kBlues : kReds, 2.0 * std::abs(step) / (kColourSteps - 1));
}

ErrorMap error_map(const MappedErrors& mapped, double scale) {
    const std::span<const float> errors = mapped.errors;
    const int height_px = static_cast<int>(errors.size()) / mapped.width_px;
    ErrorMap map{.side = std::max(block_side(mapped.width_px, height_px), mapped.least_side)};
    map.width_px = blocks(mapped.width_px, map.side);
    map.height_px = blocks(height_px, map.side);

    const auto size =
        static_cast<std::size_t>(map.width_px) * static_cast<std::size_t>(map.height_px);
    std::vector<float> largest(size, 0.0F);
    std::vector<char> has_error(size, 0);
    std::vector<char> is_bad(size, 0);
    for_each_in_blocks(mapped.width_px, height_px, map.side, [&](std::size_t block, std::size_t i) {
        if (!std::isfinite(mapped.image[i]) || !std::isfinite(mapped.reference[i])) {
            is_bad[block] = 1;
        } else if (!std::isnan(errors[i])) {
            has_error[block] = 1;
            if (std::abs(errors[i]) > std::abs(largest[block])) largest[block] = errors[i];
        }
    });

    std::vector<std::uint32_t> pixels(size, kEdgeColour);
    for (std::size_t i = 0; i < size; ++i) {
        if (has_error[i] != 0) pixels[i] = colour_of(largest[i], scale);
        if (is_bad[i] != 0) pixels[i] = kNotFiniteColour;
    }
    map.png = png_of(pixels, map.width_px, map.height_px);
    return map;
}

std::vector<PagePart> error_rule(std::string a, std::string b, std::string black) {
    return {"e = (a − b) / max(|b|, b₀)",
            PageList{{"a", std::move(a)}, {"b", std::move(b)}, {"b₀", std::move(black)}}};
}

std::vector<PagePart> error_map_parts(const MappedErrors& mapped) {
    const double end = map_scale(*mapped.comparison);
    const ErrorMap map = error_map(mapped, end);
    const PagePicture picture{.bytes = map.png,
                              .width_px = map.width_px,
                              .height_px = map.height_px,
                              .words = "map of the relative error",
                              .ring = worst_place(mapped)};
    return {PageFigures{.figures = {{.pictures = {picture}}}},
            map_legend(mapped, end),
            map_in_words(mapped, map, end)};
}

PagePlot profile_plot(std::string_view id,
                      bool is_row,
                      int pixels,
                      std::span<const Profile> profiles) {
    constexpr double kValueHeight = 150.0;
    constexpr double kErrorHeight = 72.0;
    constexpr double kGap = 12.0;
    const SvgAxis errors = error_axis(profiles);
    SvgPanel panel{.left = kAxisWidth, .width = 980.0, .x = linear_axis(0.0, pixels, 10)};
    const auto next_panel = [&](double height, SvgAxis axis, std::string title, bool is_last) {
        panel.top = panel.bottom() + kGap;
        panel.height = height;
        panel.y = std::move(axis);
        panel.y.title = std::move(title);
        if (is_last) panel.x.title = is_row ? "column [px]" : "row [px]";
        return svg_axes(panel);
    };
    std::string svg;
    for (const Profile& profile : profiles) {
        const bool is_last = &profile == &profiles.back();
        const bool has_errors = !profile.errors.empty();
        const auto style = [&](std::string_view whose) {
            return fmt::format(R"(class="{0}" {1} id="{2}-{3}-{0}")",
                               whose,
                               tone_of(profile.channel),
                               is_row ? "row" : "column",
                               escaped(profile.channel));
        };
        svg +=
            next_panel(kValueHeight, value_axis(profile), profile.channel, is_last && !has_errors);
        svg += svg_curve(panel, profile.position_px, profile.reference, style("reference"));
        svg += svg_curve(panel, profile.position_px, profile.image, style("rendered"));
        if (!has_errors) continue;
        svg += next_panel(kErrorHeight, errors, "e", is_last);
        for (const double level : {profile.bound, -profile.bound}) {
            if (std::abs(level) <= panel.y.last) svg += svg_level(panel, level, R"(class="bound")");
        }
        svg += svg_dots(panel, profile.position_px, profile.errors, style("dots"));
    }
    return {svg_drawing(id,
                        is_row ? "along the middle row" : "down the middle column",
                        panel.right() + 14.0,
                        panel.bottom() + kAxisHeight,
                        svg)};
}

}  // namespace aphotic
