// SPDX-License-Identifier: BSD-3-Clause
#include "report/plot.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "report/page_style.h"
#include "report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace aphotic {
namespace {

constexpr double kWidth = 960.0;
constexpr double kHeight = 560.0;  // of a panel with its surroundings
constexpr double kEdge = 24.0;
constexpr double kPanelWidth = kWidth - kEdge - kAxisWidth;

std::string dot_style(const PlotCurve& curve) {
    return fmt::format(R"(class="dots" style="stroke-width: 9px" {})", svg_tone(curve.tone));
}

std::string curve_style(const PlotCurve& curve) {
    return fmt::format(
        R"(class="curve{}" {})", curve.dashed ? " dashed" : "", svg_tone(curve.tone));
}

// Samples and labels in rows; moves top below them.
std::string legend(const Plot& plot, double& top) {
    constexpr double kSample = 26.0;
    constexpr double kGap = 8.0;
    constexpr double kFont_px = 13.0;
    std::string svg;
    double x = kWidth;  // makes the first label start a row
    for (const PlotCurve& curve : plot.curves) {
        if (curve.label.empty()) continue;
        const double text_room = kPanelWidth - kSample - kGap;
        const double width = std::min(text_width(curve.label, kFont_px), text_room);
        if (x + kSample + kGap + width > kWidth - kEdge) {
            x = kAxisWidth;
            top += 20.0;
        }
        svg += curve.dots
                   ? fmt::format(R"(<path stroke-linecap="round" {} d="M{} {}h0"/>)",
                                 dot_style(curve),
                                 x + 0.5 * kSample,
                                 top - 4.0)
                   : fmt::format(
                         R"(<path {} d="M{} {}h{}"/>)", curve_style(curve), x, top - 4.0, kSample);
        svg += svg_text(x + kSample + kGap,
                        top,
                        SvgAnchor::Start,
                        R"(class="axis")" + svg_fit(curve.label, kFont_px, text_room),
                        curve.label);
        x += kSample + kGap + width + 2.0 * kGap;
    }
    return svg;
}

constexpr int kTicksX = 8;
constexpr int kTicksY = 6;

void widen(SvgAxis& axis, double length, int ticks) {
    const double middle = std::midpoint(axis.first, axis.last);
    SvgAxis wider = linear_axis(middle - 0.5 * length, middle + 0.5 * length, ticks);
    wider.title = std::move(axis.title);
    axis = std::move(wider);
}

void make_equal(SvgPanel& panel) {
    const double unit = std::max((panel.x.last - panel.x.first) / panel.width,
                                 (panel.y.last - panel.y.first) / panel.height);
    widen(panel.x, unit * panel.width, kTicksX);
    widen(panel.y, unit * panel.height, kTicksY);
}

SvgPanel panel_of(const Plot& plot) {
    ValueRange x;
    ValueRange y;
    for (const PlotCurve& curve : plot.curves) {
        for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
            const bool drawable = std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) &&
                                  (!plot.log_y || curve.y[i] > 0.0);
            if (!drawable) continue;
            x.include(curve.x[i]);
            y.include(curve.y[i]);
        }
    }
    if (plot.from_zero) y.include(0.0);
    if (x.is_empty()) throw InputError("plot '{}': found no point that can be drawn", plot.title);
    SvgPanel panel{
        .left = kAxisWidth,
        .width = kPanelWidth,
        .x = x.least < x.most ? linear_axis(x.least, x.most, kTicksX)
                              : linear_axis_around(x.least, x.most, kTicksX),
        .y = plot.log_y ? log_axis(y.least, y.most) : linear_axis_around(y.least, y.most, kTicksY)};
    panel.x.title = plot.x_label;
    panel.y.title = plot.y_label;
    return panel;
}

// A dot for each point, with its name, if any, above and to the right.
std::string marked_points(const SvgPanel& panel, const PlotCurve& curve) {
    std::string svg = svg_dots(panel, curve.x, curve.y, dot_style(curve));
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        svg += svg_text(panel.x_px(curve.x.at(i)) + 5.0,
                        panel.y_px(curve.y.at(i)) - 7.0,
                        SvgAnchor::Start,
                        R"(class="label")",
                        curve.points[i]);
    }
    return svg;
}

std::string title_of(const Plot& plot, double& top) {
    constexpr double kTitle_px = 18.0;
    constexpr double kBold = 1.15;  // relative width
    top += kEdge + kTitle_px;
    std::string svg =
        svg_text(kAxisWidth,
                 top,
                 SvgAnchor::Start,
                 R"(class="title")" + svg_fit(plot.title, kTitle_px, kPanelWidth / kBold),
                 plot.title);
    top += 6.0;
    return svg;
}

std::string drawing_of(const Plot& plot, double top, double height, bool has_title) {
    SvgPanel panel = panel_of(plot);
    panel.top = top;
    std::string svg = has_title ? title_of(plot, panel.top) : "";
    svg += legend(plot, panel.top);
    panel.top += 14.0;
    panel.height = top + height - kAxisHeight - panel.top;
    if (plot.equal_axes) make_equal(panel);
    svg += svg_axes(panel);
    for (const double mark : plot.marks_x) {
        if (!(mark >= panel.x.first && mark <= panel.x.last)) continue;
        const double x = panel.x_px(mark);
        svg += svg_line(x, panel.top, x, panel.bottom(), R"(class="guide")");
    }
    for (const PlotCurve& curve : plot.curves) {
        if (!curve.dots) svg += svg_curve(panel, curve.x, curve.y, curve_style(curve));
        if (curve.dots || !curve.points.empty()) svg += marked_points(panel, curve);
    }
    return svg + '\n';
}

// All panels, below what is drawn first.
std::string plots_svg(std::string_view id,
                      std::span<const Plot> panels,
                      double height,
                      bool is_file,
                      std::string svg) {
    if (panels.empty()) throw InputError("plot: found no panel to draw; allowed: one or more");
    double top = 0.0;
    for (const Plot& plot : panels) {
        svg += drawing_of(plot, top, height, is_file);
        top += height;
    }
    return svg_drawing(id, panels.front().title, kWidth, is_file ? top + kEdge : top, svg);
}

}  // namespace

std::string page_plot(std::string_view id, std::span<const Plot> panels, double height) {
    return plots_svg(id, panels, height, false, "");
}

void write_plots(std::span<const Plot> panels, const std::filesystem::path& file) {
    if (file.extension() != ".svg") {
        throw InputError(
            "{}: found a plot file that ends in '{}'; allowed: .svg (a browser or rsvg-convert "
            "makes it a PNG)",
            file.string(),
            file.extension().string());
    }
    const std::string style = fmt::format(
        "<style>\n{}svg {{ font-family: sans-serif; }}</style>\n"
        R"(<rect width="100%" height="100%" fill="#ffffff"/>)",
        style_sheets()[0].css);
    write_text_file(file, plots_svg("plot", panels, kHeight, true, style));
}

}  // namespace aphotic
