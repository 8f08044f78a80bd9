// SPDX-License-Identifier: BSD-3-Clause
#include "report/svg.h"

#include "report/html.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

double power_of_ten_below(double value) {
    // The margin keeps 1000 from being taken for 999.999.
    return std::pow(10.0, std::floor(std::log10(value) + 1e-9));
}

double nice_step(double span, int wanted) {
    const double rough = span / wanted;
    const double power = power_of_ten_below(rough);
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (rough <= factor * power * 1.0001) return factor * power;
    }
    return 10.0 * power;
}

std::string line(double x1, double y1, double x2, double y2, std::string_view style) {
    return fmt::format(
        R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" {}/>)", x1, y1, x2, y2, style);
}

}  // namespace

double SvgAxis::fraction(double value) const {
    if (!log) return (value - first) / (last - first);
    if (!(value > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    return std::log(value / first) / std::log(last / first);
}

SvgAxis linear_axis(double first, double last, int wanted, int unit_log10) {
    SvgAxis axis{.first = first, .last = last, .log = false, .ticks = {}};
    const double step = nice_step(last - first, wanted);
    // A tick at the very end must not be lost to rounding.
    const double margin = 1e-9 * step;
    const auto from = static_cast<long>(std::ceil((first - margin) / step));
    const auto to = static_cast<long>(std::floor((last + margin) / step));
    for (long i = from; i <= to; ++i) {
        const double value = static_cast<double>(i) * step;
        axis.ticks.push_back({value, plain(value / std::pow(10.0, unit_log10))});
    }
    return axis;
}

SvgAxis log_axis(double least, double most) {
    SvgAxis axis{.first = 0.0, .last = 0.0, .log = true, .ticks = {}};
    constexpr double kManyDecades = 100.0;
    const bool labels_between = most / least < kManyDecades;
    for (double power = power_of_ten_below(least); axis.last < most; power *= 10.0) {
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double value = factor * power;
            if (value <= least) axis.ticks.clear();
            if (axis.ticks.empty()) axis.first = value;
            const bool labelled = factor == 1.0 || labels_between;
            const int exponent = static_cast<int>(std::lround(std::log10(power)));
            axis.ticks.push_back({value, labelled ? power_label(factor, exponent) : ""});
            axis.last = value;
            if (value >= most) break;
        }
    }
    return axis;
}

double round_up(double value) {
    const double power = power_of_ten_below(value);
    for (const double factor : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        if (value <= factor * power) return factor * power;
    }
    return 10.0 * power;
}

std::string svg_grid(const SvgPanel& panel) {
    std::string svg;
    for (const SvgTick& tick : panel.x.ticks) {
        const double x = panel.x_px(tick.value);
        svg += line(x, panel.top, x, panel.bottom(), R"(class="grid")");
    }
    for (const SvgTick& tick : panel.y.ticks) {
        const double y = panel.y_px(tick.value);
        svg += line(panel.left, y, panel.right(), y, R"(class="grid")");
    }
    return svg +
           fmt::format(
               R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" class="frame"/>)",
               panel.left,
               panel.top,
               panel.width,
               panel.height);
}

std::string svg_x_labels(const SvgPanel& panel) {
    std::string svg;
    for (const SvgTick& tick : panel.x.ticks) {
        svg += svg_text(panel.x_px(tick.value),
                        panel.bottom() + 16.0,
                        SvgAnchor::Middle,
                        R"(class="tick")",
                        tick.label);
    }
    return svg;
}

std::string svg_y_labels(const SvgPanel& panel) {
    std::string svg;
    for (const SvgTick& tick : panel.y.ticks) {
        if (tick.label.empty()) continue;
        svg += svg_text(panel.left - 7.0,
                        panel.y_px(tick.value) + 4.0,
                        SvgAnchor::End,
                        R"(class="tick")",
                        tick.label);
    }
    return svg;
}

std::string svg_curve(const SvgPanel& panel,
                      std::span<const double> x,
                      std::span<const double> y,
                      std::string_view style) {
    std::string path;
    bool drawing = false;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double y_px = panel.y_px(y[i]);
        const bool shown = std::isfinite(y_px);
        if (shown)
            path += fmt::format("{}{:.1f} {:.1f}", drawing ? "L" : "M", panel.x_px(x[i]), y_px);
        drawing = shown;
    }
    return fmt::format(R"(<path {} d="{}"/>)", style, path);
}

// Each dot is a line of no length, whose round ends are all that is seen of it.
std::string svg_dots(const SvgPanel& panel,
                     std::span<const double> x,
                     std::span<const double> y,
                     std::string_view style) {
    std::string path;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double y_px = panel.y_px(y[i]);
        if (std::isfinite(y_px)) path += fmt::format("M{:.1f} {:.1f}h0", panel.x_px(x[i]), y_px);
    }
    return fmt::format(R"(<path stroke-linecap="round" {} d="{}"/>)", style, path);
}

std::string svg_text(
    double x_px, double y_px, SvgAnchor anchor, std::string_view style, std::string_view text) {
    static constexpr std::array<std::string_view, 3> kAnchors{"start", "middle", "end"};
    return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" {}>{}</text>)",
                       x_px,
                       y_px,
                       kAnchors[static_cast<std::size_t>(anchor)],
                       style,
                       escaped(text));
}

std::string svg_upward_text(double x_px,
                            double y_px,
                            std::string_view style,
                            std::string_view text) {
    return fmt::format(
        R"svg(<text transform="translate({:.1f} {:.1f}) rotate(-90)" text-anchor="middle" {}>{}</text>)svg",
        x_px,
        y_px,
        style,
        escaped(text));
}

std::string svg_drawing(std::string_view id,
                        double width,
                        double height,
                        std::string_view elements) {
    return fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" id="{}" viewBox="0 0 {:.0f} {:.0f}" role="img">{}</svg>)"
        "\n",
        id,
        width,
        height,
        elements);
}

}  // namespace aphotic
