// SPDX-License-Identifier: BSD-3-Clause
#include "validation/error_view.h"

#include "report/html.h"
#include "report/svg.h"
#include "validation/report_pictures.h"
#include "validation/report_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace aphotic {
namespace {

struct MapScale {
    double end = 0.0;        // of the colours
    std::size_t beyond = 0;  // pixels
};

MapScale map_scale(const MappedErrors& mapped) {
    std::vector<double> sizes;
    for (const float e : mapped.errors) {
        if (std::isfinite(e)) sizes.push_back(std::abs(e));
    }
    double percentile = 0.0;
    if (!sizes.empty()) {
        const auto rank =
            static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(sizes.size() - 1));
        std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
        percentile = sizes[static_cast<std::size_t>(rank)];
    }
    // Mostly equal images have no scale of their own.
    const Comparison& comparison = *mapped.comparison;
    if (percentile == 0.0)
        percentile = comparison.bound > 0.0 ? comparison.bound : comparison.max_error;
    if (percentile == 0.0) percentile = 1e-3;
    const double end = round_up(percentile);
    const auto beyond = std::ranges::count_if(sizes, [&](double size) { return size > end; });
    return {.end = end, .beyond = static_cast<std::size_t>(beyond)};
}

std::string map_marks(const MappedErrors& mapped) {
    const Comparison& comparison = *mapped.comparison;
    const double width = mapped.width_px;
    const double height = static_cast<double>(mapped.errors.size()) / width;
    const double unit = width / 100.0;
    std::string svg;
    const auto notch = [&](double x1, double y1, double x2, double y2) {
        svg += svg_line(x1, y1, x2, y2, R"(class="notch")");
    };
    const double row = mapped.row + 0.5;
    const double column = mapped.column + 0.5;
    notch(0.0, row, 2.0 * unit, row);
    notch(width - 2.0 * unit, row, width, row);
    notch(column, 0.0, column, 2.0 * unit);
    notch(column, height - 2.0 * unit, column, height);
    if (comparison.max_error > 0.0) {
        for (const std::string_view style : {"halo", "ring"}) {
            svg += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" class="{}"/>)",
                               comparison.column + 0.5,
                               comparison.row + 0.5,
                               1.3 * unit,
                               style);
        }
    }
    return fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" class="marks" viewBox="0 0 {:.0f} {:.0f}">{}</svg>)",
        width,
        height,
        svg);
}

std::string swatch(std::uint32_t colour, std::string_view words) {
    return html_key(fmt::format(R"(<svg class="swatch" viewBox="0 0 12 12"><rect width="12" )"
                                R"(height="12" fill="#{:06x}"/></svg>)",
                                colour),
                    words);
}

std::string map_legend(const MappedErrors& mapped) {
    const Comparison& comparison = *mapped.comparison;
    std::string legend =
        swatch(error_colour((kColourSteps - 1) / 2), mapped.image_name + " is brighter") +
        swatch(error_colour(-(kColourSteps - 1) / 2), mapped.image_name + " is darker");
    if (!mapped.set_apart.empty()) legend += swatch(kEdgeColour, mapped.set_apart);
    if (comparison.not_finite > 0) {
        legend +=
            swatch(kNotFiniteColour, "not finite: " + counted(comparison.not_finite, "sample"));
    }
    if (comparison.max_error > 0.0) {
        legend += html_key("◯",
                           fmt::format("the largest, {} at column {}, row {}",
                                       scientific(comparison.max_error),
                                       comparison.column,
                                       comparison.row));
    }
    return html_legend(legend);
}

std::string map_in_words(const ErrorMap& map, const MapScale& scale) {
    std::string words = fmt::format("The colours run from −{0} to +{0}", scientific(scale.end));
    words += scale.beyond == 0 ? "; no pixel is beyond."
                               : fmt::format("; {} beyond, shown in the end’s colour.",
                                             counted(scale.beyond, "pixel"));
    if (map.side > 1) {
        words += fmt::format(
            " Each point of the map shows the largest |e| of {0} × {0} pixels, with its sign.",
            map.side);
    }
    return html_paragraph(
        words + " The notches at the sides mark the row and the column of the profiles below.");
}

}  // namespace

std::string error_rule(std::string_view a, std::string_view b, std::string_view black) {
    const std::array<HtmlItem, 3> symbols{{{"<i>a</i>", std::string(a)},
                                           {"<i>b</i>", std::string(b)},
                                           {"<i>b</i><sub>0</sub>", std::string(black)}}};
    return "<div class=\"rule\">\n<p class=\"formula\"><i>e<sub>i</sub></i> = "
           "<span class=\"fraction\"><span><i>a<sub>i</sub></i> − <i>b<sub>i</sub></i></span>"
           "<span>max( |<i>b<sub>i</sub></i>|, <i>b</i><sub>0</sub> )</span></span></p>\n" +
           html_list("symbols", symbols) + "</div>\n";
}

std::string error_map_html(const MappedErrors& mapped) {
    const MapScale scale = map_scale(mapped);
    const ErrorMap map = error_map(mapped.errors,
                                   mapped.image,
                                   mapped.reference,
                                   mapped.width_px,
                                   scale.end,
                                   mapped.least_side);
    return fmt::format("<div class=\"map\"><div class=\"frame\">{}{}</div>\n{}</div>\n",
                       picture_html(
                           map.png, map.width_px, map.height_px, "map of the relative error", true),
                       map_marks(mapped),
                       colour_bar_svg(scale.end, mapped.bar_id)) +
           map_legend(mapped) + map_in_words(map, scale);
}

}  // namespace aphotic
