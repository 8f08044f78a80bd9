// SPDX-License-Identifier: BSD-3-Clause
#include "validation/error_view.h"

#include "report/html.h"
#include "report/svg.h"
#include "validation/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace aphotic {
namespace {

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

std::vector<PagePart> error_rule(std::string a, std::string b, std::string black) {
    return {"e = (a − b) / max(|b|, b₀)",
            PageList{{"a", std::move(a)}, {"b", std::move(b)}, {"b₀", std::move(black)}}};
}

std::vector<PagePart> error_map_parts(const MappedErrors& mapped) {
    const double end = map_scale(*mapped.comparison);
    const ErrorMap map = error_map(
        mapped.errors, mapped.image, mapped.reference, mapped.width_px, end, mapped.least_side);
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
