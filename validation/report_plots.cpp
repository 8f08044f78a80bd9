// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report_plots.h"

#include "report/html.h"
#include "report/svg.h"
#include "validation/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

namespace aphotic {
namespace {

constexpr double kWidth = 1080.0;
constexpr double kLeft = 92.0;
constexpr double kPanelWidth = kWidth - kLeft - 14.0;
constexpr std::array<std::string_view, kChannels> kClasses{"red", "green", "blue"};

std::string_view word(ProfileLine line) {
    return line == ProfileLine::Row ? "row" : "column";
}

int length_px(const ValidationReport& report, ProfileLine line) {
    return line == ProfileLine::Row ? report.traced.width_px : report.traced.height_px;
}

// More points than that are not told apart on a page.
constexpr std::size_t kMostPoints = 1500;

// One point of every so many. With by_size, it is the one of the largest |y|, so that no error
// is lost.
struct Points {
    std::vector<double> x;
    std::vector<double> y;
};
Points thinned(std::span<const double> x, std::span<const double> y, bool by_size) {
    const std::size_t step = (x.size() + kMostPoints - 1) / kMostPoints;
    Points points;
    for (std::size_t first = 0; first < x.size(); first += step) {
        std::size_t chosen = first;
        for (std::size_t i = first; by_size && i < std::min(first + step, x.size()); ++i) {
            if (std::abs(y[i]) > std::abs(y[chosen]) || std::isnan(y[chosen])) chosen = i;
        }
        points.x.push_back(x[chosen]);
        points.y.push_back(y[chosen]);
    }
    return points;
}

double largest_size(std::span<const double> values) {
    double largest = 0.0;
    for (const double value : values) {
        if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
    return largest;
}

// The exponent that the numbers of an axis share, such as -4 for errors of a few 1e-4; 0 for
// numbers of ordinary size, which are written out.
int unit_log10(double largest) {
    if (!(largest > 0.0)) return 0;
    const int exponent = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
    return exponent < -2 || exponent > 3 ? exponent : 0;
}

// "e / 10⁻⁴", or "e" alone.
std::string over_unit(const std::string& quantity, int log10) {
    return log10 == 0 ? quantity : quantity + " / " + power_label(1.0, log10);
}

// In whole degrees off the camera's axis, at the sensor's side of any port.
SvgAxis degree_axis(const Camera& camera, int pixels) {
    const double focal_px = camera.focal_length_m / camera.pixel_pitch_m;
    const double half_deg = std::atan(pixels / 2.0 / focal_px) * 180.0 / std::numbers::pi;
    SvgAxis axis{.first = 0.0, .last = static_cast<double>(pixels), .log = false, .ticks = {}};
    for (const SvgTick& tick : linear_axis(-half_deg, half_deg, 10).ticks) {
        const double place =
            pixels / 2.0 + focal_px * std::tan(tick.value * std::numbers::pi / 180.0);
        axis.ticks.push_back({place, tick.label + "°"});
    }
    return axis;
}

std::string labels_above(const SvgPanel& panel, const SvgAxis& axis) {
    std::string svg;
    for (const SvgTick& tick : axis.ticks) {
        const double x = panel.left + panel.width * axis.fraction(tick.value);
        svg += fmt::format(
            R"(<line x1="{0:.1f}" y1="{1:.1f}" x2="{0:.1f}" y2="{2:.1f}" class="notch"/>)",
            x,
            panel.top - 5.0,
            panel.top);
        svg += svg_text(x, panel.top - 9.0, SvgAnchor::Middle, R"(class="tick")", tick.label);
    }
    return svg;
}

SvgAxis signal_axis(const Profile& profile) {
    double least = 0.0;
    double most = 0.0;
    for (const auto* values : {&profile.rendered, &profile.traced}) {
        for (const double value : *values) {
            if (!std::isfinite(value)) continue;
            least = std::min(least, value);
            most = std::max(most, value);
        }
    }
    if (most == least) most = least + 1.0;
    const double last = most + 0.07 * (most - least);
    return linear_axis(least, last, 5, unit_log10(last));
}

// Shows the bound too when it is not far from the errors.
double error_scale(const ValidationReport& report, const std::vector<Profile>& profiles) {
    double largest = 0.0;
    double bound = 0.0;
    for (const Profile& profile : profiles)
        largest = std::max(largest, largest_size(profile.error));
    for (const Comparison& channel : report.channels) bound = std::max(bound, channel.bound);
    if (largest == 0.0) return bound > 0.0 ? round_up(bound) : 1.0;
    constexpr double kNear = 4.0;
    return round_up(1.05 * (bound < kNear * largest ? std::max(bound, largest) : largest));
}

std::string curve_style(ProfileLine line, std::size_t channel, std::string_view whose) {
    return fmt::format(R"(class="{} {}" id="{}-{}-{}")",
                       whose,
                       kClasses[channel],
                       word(line),
                       kChannelNames[channel],
                       whose);
}

std::string signal_panel(const SvgPanel& panel,
                         const Profile& profile,
                         ProfileLine line,
                         std::size_t channel) {
    std::string svg = svg_grid(panel) + svg_y_labels(panel);
    const Points traced = thinned(profile.position_px, profile.traced, false);
    const Points rendered = thinned(profile.position_px, profile.rendered, false);
    svg += svg_curve(panel, traced.x, traced.y, curve_style(line, channel, "reference"));
    svg += svg_curve(panel, rendered.x, rendered.y, curve_style(line, channel, "rendered"));
    const int unit = unit_log10(panel.y.last);
    return svg + svg_upward_text(20.0,
                                 panel.top + panel.height / 2.0,
                                 fmt::format(R"(class="name {}")", kClasses[channel]),
                                 over_unit(fmt::format("{} signal", kChannelNames[channel]), unit));
}

std::string error_panel(const SvgPanel& panel,
                        const Profile& profile,
                        const Comparison& comparison,
                        ProfileLine line,
                        std::size_t channel) {
    std::string svg = svg_grid(panel) + svg_y_labels(panel);
    const std::array<double, 2> ends{panel.x.first, panel.x.last};
    for (const double level : {comparison.bound, -comparison.bound}) {
        const std::array<double, 2> levels{level, level};
        if (std::abs(level) <= panel.y.last)
            svg += svg_curve(panel, ends, levels, R"(class="bound")");
    }
    const Points points = thinned(profile.position_px, profile.error, true);
    svg += svg_dots(panel, points.x, points.y, curve_style(line, channel, "dots"));
    return svg + svg_upward_text(20.0,
                                 panel.top + panel.height / 2.0,
                                 R"(class="axis")",
                                 over_unit("e", unit_log10(panel.y.last)));
}

// Of one quantity over the comparisons.
std::vector<double> values_of(std::span<const Comparison> comparisons, double Comparison::*field) {
    std::vector<double> values;
    for (const Comparison& comparison : comparisons) values.push_back(comparison.*field);
    return values;
}

struct Quantity {
    double Comparison::*field;
    std::string_view style;
};
constexpr std::array<Quantity, 3> kQuantities{{{&Comparison::max_error, "largest"},
                                               {&Comparison::percentile_999, "percentile"},
                                               {&Comparison::rms_error, "rms"}}};

SvgAxis error_axis(const ValidationReport& report) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    const auto include = [&](double value) {
        if (!std::isfinite(value) || !(value > 0.0)) return;
        least = std::min(least, value);
        most = std::max(most, value);
    };
    for (const auto& comparisons : {report.wavelengths, report.channels}) {
        for (const Comparison& comparison : comparisons) {
            include(comparison.bound);
            for (const Quantity& quantity : kQuantities) include(comparison.*quantity.field);
        }
    }
    if (most == 0.0) return log_axis(1e-6, 1e-3);
    return log_axis(0.85 * least, 1.15 * most);
}

SvgAxis wavelength_axis(const std::vector<double>& lambda_nm) {
    constexpr double kMargin_nm = 8.0;
    if (lambda_nm.empty()) return linear_axis(400.0, 700.0, 8);
    return linear_axis(lambda_nm.front() - kMargin_nm, lambda_nm.back() + kMargin_nm, 8);
}

std::string error_marks(const SvgPanel& panel,
                        std::span<const double> x,
                        std::span<const Comparison> comparisons,
                        bool joined) {
    std::string svg;
    for (const Quantity& quantity : kQuantities) {
        const std::vector<double> y = values_of(comparisons, quantity.field);
        if (joined)
            svg += svg_curve(panel, x, y, fmt::format(R"(class="error {}")", quantity.style));
        svg += svg_dots(panel, x, y, fmt::format(R"(class="mark {}")", quantity.style));
    }
    return svg;
}

// A stroke as wide as half_width to either side.
std::string bound_strokes(const SvgPanel& panel,
                          std::span<const double> x,
                          std::span<const Comparison> comparisons,
                          double half_width) {
    std::string svg;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const std::array<double, 2> ends{std::max(x[i] - half_width, panel.x.first),
                                         std::min(x[i] + half_width, panel.x.last)};
        const std::array<double, 2> levels{comparisons[i].bound, comparisons[i].bound};
        svg += svg_curve(panel, ends, levels, R"(class="bound")");
    }
    return svg;
}

// From end to end of the panel, level beyond the first and the last wavelength.
std::string bound_line(const SvgPanel& panel, const ValidationReport& report) {
    if (report.wavelengths.empty()) return "";
    std::vector<double> x = report.lambda_nm;
    std::vector<double> y = values_of(report.wavelengths, &Comparison::bound);
    x.insert(x.begin(), panel.x.first);
    y.insert(y.begin(), y.front());
    x.push_back(panel.x.last);
    y.push_back(y.back());
    return svg_curve(panel, x, y, R"(class="bound")");
}

}  // namespace

int profile_index(const ValidationReport& report, ProfileLine line) {
    return (line == ProfileLine::Row ? report.traced.height_px : report.traced.width_px) / 2;
}

Profile profile_of(const ValidationReport& report, ProfileLine line, std::size_t channel) {
    const auto width = static_cast<std::size_t>(report.traced.width_px);
    const auto height = static_cast<std::size_t>(report.traced.height_px);
    const auto index = static_cast<std::size_t>(profile_index(report, line));
    const auto count = static_cast<std::size_t>(length_px(report, line));
    Profile profile;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = channel * width * height +
                               (line == ProfileLine::Row ? index * width + i : i * width + index);
        profile.position_px.push_back(static_cast<double>(i) + 0.5);
        profile.rendered.push_back(report.rendered.samples[at]);
        profile.traced.push_back(report.traced.samples[at]);
        profile.error.push_back(report.channel_errors[at]);
    }
    return profile;
}

std::string profile_svg(const ValidationReport& report, ProfileLine line) {
    constexpr double kTop = 44.0;
    constexpr double kSignalHeight = 130.0;
    constexpr double kErrorHeight = 72.0;
    constexpr double kGap = 8.0;
    constexpr double kGapBetweenChannels = 24.0;
    const int pixels = length_px(report, line);
    std::vector<Profile> profiles;
    for (std::size_t c = 0; c < kChannels; ++c) profiles.push_back(profile_of(report, line, c));
    const double scale = error_scale(report, profiles);

    SvgPanel panel{.left = kLeft,
                   .top = kTop,
                   .width = kPanelWidth,
                   .height = 0.0,
                   .x = linear_axis(0.0, pixels, 10),
                   .y = {}};
    std::string svg = labels_above(panel, degree_axis(report.rig.camera, pixels));
    svg += svg_text(panel.left + panel.width / 2.0,
                    14.0,
                    SvgAnchor::Middle,
                    R"(class="axis")",
                    line == ProfileLine::Row ? "off the camera’s axis, port to starboard"
                                             : "off the camera’s axis, forward to aft");
    for (std::size_t c = 0; c < kChannels; ++c) {
        if (c > 0) panel.top = panel.bottom() + kGapBetweenChannels;
        panel.height = kSignalHeight;
        panel.y = signal_axis(profiles[c]);
        svg += signal_panel(panel, profiles[c], line, c);
        panel.top = panel.bottom() + kGap;
        panel.height = kErrorHeight;
        panel.y = linear_axis(-scale, scale, 4, unit_log10(scale));
        svg += error_panel(panel, profiles[c], report.channels[c], line, c);
    }
    svg += svg_x_labels(panel);
    svg += svg_text(panel.left + panel.width / 2.0,
                    panel.bottom() + 36.0,
                    SvgAnchor::Middle,
                    R"(class="axis")",
                    line == ProfileLine::Row ? "column [px]" : "row [px]");
    return svg_drawing(fmt::format("profile-{}", word(line)), kWidth, panel.bottom() + 44.0, svg);
}

std::string errors_svg(const ValidationReport& report) {
    constexpr double kHeight = 300.0;
    constexpr double kChannelsWidth = 150.0;
    constexpr double kGap = 22.0;
    SvgPanel panel{.left = kLeft,
                   .top = 12.0,
                   .width = kPanelWidth - kChannelsWidth - kGap,
                   .height = kHeight,
                   .x = wavelength_axis(report.lambda_nm),
                   .y = error_axis(report)};
    std::string svg = svg_grid(panel) + svg_x_labels(panel) + svg_y_labels(panel);
    svg += bound_line(panel, report);
    svg += error_marks(panel, report.lambda_nm, report.wavelengths, true);
    svg += svg_text(panel.left + panel.width / 2.0,
                    panel.bottom() + 36.0,
                    SvgAnchor::Middle,
                    R"(class="axis")",
                    "wavelength [nm]");
    svg +=
        svg_upward_text(18.0, panel.top + kHeight / 2.0, R"(class="axis")", "relative error |e|");

    panel.left = panel.right() + kGap;
    panel.width = kChannelsWidth;
    panel.x = {.first = -0.5, .last = kChannels - 0.5, .log = false, .ticks = {}};
    std::vector<double> places;
    for (std::size_t c = 0; c < kChannels; ++c) {
        places.push_back(static_cast<double>(c));
        panel.x.ticks.push_back({places.back(), std::string(kChannelNames[c])});
    }
    svg += svg_grid(panel) + svg_x_labels(panel);
    svg += bound_strokes(panel, places, report.channels, 0.35);
    svg += error_marks(panel, places, report.channels, false);
    svg += svg_text(panel.left + panel.width / 2.0,
                    panel.bottom() + 36.0,
                    SvgAnchor::Middle,
                    R"(class="axis")",
                    "channel");
    return svg_drawing("errors", kWidth, panel.bottom() + 44.0, svg);
}

std::string colour_bar_svg(double scale, std::string_view id) {
    constexpr double kTop = 26.0;
    constexpr double kBarWidth = 22.0;
    constexpr double kHeight = 400.0;
    constexpr int kMost = (kColourSteps - 1) / 2;
    const int unit = unit_log10(scale);
    const SvgPanel bar{.left = 4.0,
                       .top = kTop,
                       .width = kBarWidth,
                       .height = kHeight,
                       .x = {},
                       .y = linear_axis(-scale, scale, 8, unit)};
    std::string svg;
    const double step_height = kHeight / kColourSteps;
    for (int step = -kMost; step <= kMost; ++step) {
        svg += fmt::format(
            R"(<rect x="{:.1f}" y="{:.2f}" width="{:.1f}" height="{:.2f}" fill="#{:06x}"/>)",
            bar.left,
            kTop + (kMost - step) * step_height,
            bar.width,
            step_height + 0.3,  // no gaps from rounding
            error_colour(step));
    }
    for (const SvgTick& tick : bar.y.ticks) {
        const std::string sign = tick.value > 0.0 ? "+" : "";
        svg += svg_text(bar.right() + 7.0,
                        bar.y_px(tick.value) + 4.0,
                        SvgAnchor::Start,
                        R"(class="tick")",
                        sign + tick.label);
    }
    svg +=
        fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" class="frame"/>)",
                    bar.left,
                    bar.top,
                    bar.width,
                    bar.height);
    svg += svg_text(bar.left, 14.0, SvgAnchor::Start, R"(class="axis")", over_unit("e", unit));
    return svg_drawing(id, 84.0, kTop + kHeight + 12.0, svg);
}

}  // namespace aphotic
