// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report_plots.h"

#include "report/html.h"
#include "report/svg.h"
#include "validation/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace aphotic {
namespace {

constexpr double kWidth = 1080.0;
constexpr double kPanelWidth = kWidth - kAxisWidth - 14.0;

std::string_view word(ProfileLine line) {
    return line == ProfileLine::Row ? "row" : "column";
}

int length_px(const ValidationReport& report, ProfileLine line) {
    return line == ProfileLine::Row ? report.traced.width_px : report.traced.height_px;
}

struct Profile {
    std::vector<double> position_px;  // of the samples' centres: 0.5, 1.5, ...
    std::vector<double> rendered;
    std::vector<double> traced;
    std::vector<double> error;  // relative, NaN on edges
};

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

// In whole degrees off the camera's axis, at the sensor's side of any port.
SvgAxis degree_axis(const Camera& camera, int pixels) {
    const double focal_px = camera.focal_length_m / camera.pixel_pitch_m;
    const double half_deg = std::atan(pixels / 2.0 / focal_px) * 180.0 / std::numbers::pi;
    SvgAxis axis{.first = 0.0, .last = static_cast<double>(pixels)};
    for (const SvgTick& tick : linear_axis(-half_deg, half_deg, 10).ticks) {
        const double place =
            pixels / 2.0 + focal_px * std::tan(tick.value * std::numbers::pi / 180.0);
        axis.ticks.push_back({place, plain(tick.value) + "°"});
    }
    return axis;
}

std::string degrees_above(const SvgPanel& panel, const SvgAxis& axis) {
    std::string svg;
    for (const SvgTick& tick : axis.ticks) {
        const double x = panel.left + panel.width * axis.fraction(tick.value);
        svg += svg_line(x, panel.top - 5.0, x, panel.top, R"(class="notch")");
        svg += svg_text(x, panel.top - 9.0, SvgAnchor::Middle, R"(class="tick")", tick.label);
    }
    return svg + svg_text(panel.left + panel.width / 2.0,
                          14.0,
                          SvgAnchor::Middle,
                          R"(class="axis")",
                          axis.title);
}

SvgAxis signal_axis(const Profile& profile) {
    ValueRange range{.least = 0.0, .most = 0.0};
    range.include(profile.rendered);
    range.include(profile.traced);
    if (range.most == range.least) range.most = range.least + 1.0;
    return linear_axis(range.least, range.most + 0.07 * (range.most - range.least), 5);
}

// Shows the bound too when it is not far from the errors.
double error_scale(const ValidationReport& report, const std::vector<Profile>& profiles) {
    ValueRange errors{.least = 0.0, .most = 0.0};
    double bound = 0.0;
    for (const Profile& profile : profiles) errors.include(profile.error);
    for (const Comparison& channel : report.channels) bound = std::max(bound, channel.bound);
    const double largest = std::max(errors.most, -errors.least);
    if (largest == 0.0) return bound > 0.0 ? round_up(bound) : 1.0;
    constexpr double kNear = 4.0;
    return round_up(1.05 * (bound < kNear * largest ? std::max(bound, largest) : largest));
}

std::string curve_style(ProfileLine line, std::size_t channel, std::string_view whose) {
    return fmt::format(R"(class="{0}" {1} id="{2}-{3}-{0}")",
                       whose,
                       svg_tone(kChannelTones[channel]),
                       word(line),
                       kChannelNames[channel]);
}

std::string signal_panel(const SvgPanel& panel,
                         const Profile& profile,
                         ProfileLine line,
                         std::size_t channel) {
    const Points traced = thinned(profile.position_px, profile.traced, false);
    const Points rendered = thinned(profile.position_px, profile.rendered, false);
    return svg_axes(panel) +
           svg_curve(panel, traced.x, traced.y, curve_style(line, channel, "reference")) +
           svg_curve(panel, rendered.x, rendered.y, curve_style(line, channel, "rendered"));
}

std::string error_panel(const SvgPanel& panel,
                        const Profile& profile,
                        const Comparison& comparison,
                        ProfileLine line,
                        std::size_t channel) {
    std::string svg = svg_axes(panel);
    for (const double level : {comparison.bound, -comparison.bound}) {
        if (std::abs(level) <= panel.y.last) svg += svg_level(panel, level, R"(class="bound")");
    }
    const Points points = thinned(profile.position_px, profile.error, true);
    return svg + svg_dots(panel, points.x, points.y, curve_style(line, channel, "dots"));
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
    ValueRange range;
    const auto include = [&](double value) {
        if (value > 0.0) range.include(value);
    };
    for (const auto& comparisons : {report.wavelengths, report.channels}) {
        for (const Comparison& comparison : comparisons) {
            include(comparison.bound);
            for (const Quantity& quantity : kQuantities) include(comparison.*quantity.field);
        }
    }
    return range.is_empty() ? log_axis(1e-6, 1e-3)
                            : log_axis(0.85 * range.least, 1.15 * range.most);
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

std::string profile_svg(const ValidationReport& report, ProfileLine line) {
    constexpr double kSignalHeight = 130.0;
    constexpr double kErrorHeight = 72.0;
    constexpr double kGap = 8.0;
    constexpr double kGapBetweenChannels = 24.0;
    const bool is_row = line == ProfileLine::Row;
    const int pixels = length_px(report, line);
    std::vector<Profile> profiles;
    for (std::size_t c = 0; c < kChannels; ++c) profiles.push_back(profile_of(report, line, c));
    const double scale = error_scale(report, profiles);

    SvgPanel panel{.left = kAxisWidth,
                   .top = 44.0,
                   .width = kPanelWidth,
                   .height = 0.0,
                   .x = linear_axis(0.0, pixels, 10)};
    SvgAxis degrees = degree_axis(report.rig.camera, pixels);
    degrees.title = is_row ? "off the camera’s axis, port to starboard"
                           : "off the camera’s axis, forward to aft";
    std::string svg = degrees_above(panel, degrees);
    for (std::size_t c = 0; c < kChannels; ++c) {
        if (c > 0) panel.top = panel.bottom() + kGapBetweenChannels;
        panel.height = kSignalHeight;
        panel.y = signal_axis(profiles[c]);
        panel.y.title = fmt::format("{} signal", kChannelNames[c]);
        panel.y.title_style = R"(class="name" )" + svg_tone(kChannelTones[c]);
        svg += signal_panel(panel, profiles[c], line, c);
        panel.top = panel.bottom() + kGap;
        panel.height = kErrorHeight;
        panel.y = linear_axis(-scale, scale, 4);
        panel.y.title = "e";
        if (c + 1 == kChannels) panel.x.title = is_row ? "column [px]" : "row [px]";
        svg += error_panel(panel, profiles[c], report.channels[c], line, c);
    }
    return svg_drawing(
        fmt::format("profile-{}", word(line)),
        fmt::format("signals and errors along {} {}", word(line), profile_index(report, line)),
        kWidth,
        panel.bottom() + kAxisHeight,
        svg);
}

std::string errors_svg(const ValidationReport& report) {
    constexpr double kChannelsWidth = 150.0;
    constexpr double kGap = 22.0;
    SvgPanel panel{.left = kAxisWidth,
                   .top = 12.0,
                   .width = kPanelWidth - kChannelsWidth - kGap,
                   .height = 300.0,
                   .x = wavelength_axis(report.lambda_nm),
                   .y = error_axis(report)};
    panel.x.title = "wavelength [nm]";
    panel.y.title = "relative error |e|";
    std::string svg = svg_axes(panel) + bound_line(panel, report) +
                      error_marks(panel, report.lambda_nm, report.wavelengths, true);

    panel.left = panel.right() + kGap;
    panel.width = kChannelsWidth;
    panel.x = {.first = -0.5, .last = kChannels - 0.5, .title = "channel"};
    panel.y.title.clear();
    std::vector<double> places;
    for (std::size_t c = 0; c < kChannels; ++c) {
        places.push_back(static_cast<double>(c));
        panel.x.ticks.push_back({places.back(), std::string(kChannelNames[c])});
    }
    svg += svg_axes(panel);
    for (std::size_t c = 0; c < kChannels; ++c) {
        constexpr double kHalf = 0.35;
        svg += svg_level(panel,
                         report.channels[c].bound,
                         R"(class="bound")",
                         places[c] - kHalf,
                         places[c] + kHalf);
    }
    svg += error_marks(panel, places, report.channels, false);
    return svg_drawing("errors",
                       "relative error over wavelength and of the channels",
                       kWidth,
                       panel.bottom() + kAxisHeight,
                       svg);
}

std::string colour_bar_svg(double scale, std::string_view id) {
    constexpr double kHeight = 400.0;
    constexpr int kMost = (kColourSteps - 1) / 2;
    const SvgPanel bar{.left = 4.0,
                       .top = 26.0,
                       .width = 22.0,
                       .height = kHeight,
                       .y = linear_axis(-scale, scale, 8)};
    std::string svg;
    const double step_height = kHeight / kColourSteps;
    for (int step = -kMost; step <= kMost; ++step) {
        svg += fmt::format(
            R"(<rect x="{:.1f}" y="{:.2f}" width="{:.1f}" height="{:.2f}" fill="#{:06x}"/>)",
            bar.left,
            bar.top + (kMost - step) * step_height,
            bar.width,
            step_height + 0.3,  // no gaps from rounding
            error_colour(step));
    }
    for (const SvgTick& tick : bar.y.ticks) {
        svg += svg_text(bar.right() + 7.0,
                        bar.y_px(tick.value) + 4.0,
                        SvgAnchor::Start,
                        R"(class="tick")",
                        (tick.value > 0.0 ? "+" : "") + tick.label);
    }
    svg += svg_frame(bar.left, bar.top, bar.width, bar.height);
    svg += svg_text(bar.left, 14.0, SvgAnchor::Start, R"(class="axis")", bar.y.in_unit("e"));
    return svg_drawing(id, "the colours of the errors", 84.0, bar.bottom() + 12.0, svg);
}

}  // namespace aphotic
