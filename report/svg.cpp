// SPDX-License-Identifier: BSD-3-Clause
#include "report/svg.h"

#include "report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

constexpr double kAxisFont_px = 13.0;

double power_of_ten_below(double value) {
    // The margin prevents 999.999 from being mistaken for 1000.
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

// The common exponent of an axis's numbers, such as -4 for errors of a few 1e-4; 0 for numbers of
// ordinary size, which are written in full.
int unit_log10_of(double largest) {
    if (!(largest > 0.0)) return 0;
    const int exponent = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
    return exponent < -2 || exponent > 4 ? exponent : 0;
}

SvgAxis linear_axis_of(double first, double last, double step) {
    SvgAxis axis{.first = first,
                 .last = last,
                 .unit_log10 = unit_log10_of(std::max(std::abs(first), std::abs(last)))};
    // A tick at the very end must not be lost to rounding.
    constexpr double kMargin = 1e-6;
    for (double i = std::ceil(first / step - kMargin); i <= last / step + kMargin; i += 1.0) {
        const double value = i * step;
        axis.ticks.push_back({value, plain(value / std::pow(10.0, axis.unit_log10))});
    }
    return axis;
}

std::string upward_text(double x_px, double y_px, std::string_view style, std::string_view text) {
    return fmt::format(
        R"svg(<text transform="translate({:.1f} {:.1f}) rotate(-90)" text-anchor="middle" {}>{}</text>)svg",
        x_px,
        y_px,
        style,
        escaped(text));
}

std::string title_style(std::string_view title, double room) {
    return R"(class="axis")" + svg_fit(title, kAxisFont_px, room);
}

}  // namespace

std::string svg_tone(std::size_t tone) {
    return fmt::format(R"(color="{}")", kTones[tone % kTones.size()]);
}

double SvgAxis::fraction(double value) const {
    if (!log) return (value - first) / (last - first);
    if (!(value > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    return std::log(value / first) / std::log(last / first);
}

std::string SvgAxis::in_unit(std::string_view quantity) const {
    if (unit_log10 == 0) return std::string(quantity);
    return fmt::format("{} / {}", quantity, power_label(1.0, unit_log10));
}

SvgAxis linear_axis(double first, double last, int wanted) {
    return linear_axis_of(first, last, nice_step(last - first, wanted));
}

SvgAxis linear_axis_around(double least, double most, int wanted) {
    if (least >= 0.0 && least <= 0.5 * most) least = 0.0;
    if (least == most) {
        const double room = least == 0.0 ? 1.0 : 0.1 * std::abs(least);
        least -= room;
        most += room;
    }
    constexpr double kMargin = 1e-6;
    const double step = nice_step(most - least, wanted);
    return linear_axis_of(
        step * std::floor(least / step + kMargin), step * std::ceil(most / step - kMargin), step);
}

SvgAxis log_axis(double least, double most, int most_labels) {
    constexpr std::array<int, 3> kFactors{1, 2, 5};
    struct Place {
        int exponent = 0;
        int factor = 1;
    };
    SvgAxis axis{.log = true};
    std::vector<Place> places;
    const auto is_over = [&] { return places.size() > 1 && axis.last >= most; };
    for (int exponent = static_cast<int>(std::floor(std::log10(least) + 1e-9)); !is_over();
         ++exponent) {
        for (const int factor : kFactors) {
            const double value = factor * std::pow(10.0, exponent);
            if (value <= least) {
                axis.ticks.clear();
                places.clear();
            }
            if (places.empty()) axis.first = value;
            axis.last = value;
            axis.ticks.push_back({value, ""});
            places.push_back({exponent, factor});
            if (is_over()) break;
        }
    }
    const int decades = places.back().exponent - places.front().exponent + 1;
    const int every = (decades + most_labels - 1) / most_labels;
    const bool all = places.size() <= static_cast<std::size_t>(most_labels);
    const bool written_out = axis.first > 0.00099 && axis.last < 1e4;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto [exponent, factor] = places[i];
        if (all || (factor == 1 && exponent % every == 0))
            axis.ticks[i].label =
                written_out ? plain(axis.ticks[i].value) : power_label(factor, exponent);
    }
    if (every > 1)
        std::erase_if(axis.ticks, [](const SvgTick& tick) { return tick.label.empty(); });
    return axis;
}

double round_up(double value) {
    const double power = power_of_ten_below(value);
    for (const double factor : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        if (value <= factor * power) return factor * power;
    }
    return 10.0 * power;
}

void ValueRange::include(double value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
}

void ValueRange::include(std::span<const double> values) {
    for (const double value : values) include(value);
}

std::string svg_axes(const SvgPanel& panel) {
    constexpr std::string_view kTick = R"(class="tick")";
    std::string svg;
    for (const SvgTick& tick : panel.x.ticks) {
        const double x = panel.x_px(tick.value);
        svg += svg_line(x, panel.top, x, panel.bottom(), R"(class="grid")");
        if (panel.x.title.empty() || tick.label.empty()) continue;
        svg += svg_text(x, panel.bottom() + 16.0, SvgAnchor::Middle, kTick, tick.label);
    }
    for (const SvgTick& tick : panel.y.ticks) {
        const double y = panel.y_px(tick.value);
        svg += svg_line(panel.left, y, panel.right(), y, R"(class="grid")");
        if (panel.y.title.empty() || tick.label.empty()) continue;
        svg += svg_text(panel.left - 7.0, y + 4.0, SvgAnchor::End, kTick, tick.label);
    }
    svg +=
        fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" class="frame"/>)",
                    panel.left,
                    panel.top,
                    panel.width,
                    panel.height);
    if (!panel.x.title.empty()) {
        const std::string title = panel.x.in_unit(panel.x.title);
        svg += svg_text(panel.left + panel.width / 2.0,
                        panel.bottom() + 37.0,
                        SvgAnchor::Middle,
                        title_style(title, panel.width),
                        title);
    }
    if (!panel.y.title.empty()) {
        const std::string title = panel.y.in_unit(panel.y.title);
        svg += upward_text(
            16.0, panel.top + panel.height / 2.0, title_style(title, panel.height), title);
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
        const double x_px = panel.x_px(x[i]);
        const double y_px = panel.y_px(y[i]);
        const bool shown = std::isfinite(x_px) && std::isfinite(y_px);
        if (shown) path += fmt::format("{}{:.1f} {:.1f}", drawing ? "L" : "M", x_px, y_px);
        drawing = shown;
    }
    return fmt::format(R"(<path {} d="{}"/>)", style, path);
}

// Each dot is a line of zero length, of which only the round ends are visible.
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

std::string svg_level(const SvgPanel& panel, double y, std::string_view style) {
    return svg_line(panel.left, panel.y_px(y), panel.right(), panel.y_px(y), style);
}

std::string svg_line(double x1, double y1, double x2, double y2, std::string_view style) {
    return fmt::format(
        R"(<line x1="{:.2f}" y1="{:.2f}" x2="{:.2f}" y2="{:.2f}" {}/>)", x1, y1, x2, y2, style);
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

double text_width(std::string_view text, double font_px) {
    constexpr double kLetter = 0.6;  // DejaVu Sans, a wide face
    double letters = 0.0;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool continues = byte >= 0x80 && byte < 0xC0;
        // From U+0800 on: most of these are Chinese, Japanese and Korean, as wide as high.
        if (!continues) letters += byte >= 0xE0 ? 1.7 : 1.0;
    }
    return kLetter * font_px * letters;
}

std::string svg_fit(std::string_view text, double font_px, double room) {
    const double width = text_width(text, font_px);
    if (width <= room) return "";
    return fmt::format(R"( style="font-size: {:.2f}px")", font_px * room / width);
}

std::string svg_drawing(std::string_view id,
                        std::string_view name,
                        double width,
                        double height,
                        std::string_view elements) {
    return fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" id="{}" viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="{}">{}</svg>)"
        "\n",
        id,
        width,
        height,
        escaped(name),
        elements);
}

}  // namespace aphotic
