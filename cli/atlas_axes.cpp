// SPDX-License-Identifier: BSD-3-Clause
#include "cli/atlas_axes.h"

#include "base/degrees.h"
#include "base/error.h"
#include "cli/options.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

namespace aphotic::cli {
namespace {

struct Bounds {
    double least;
    double most;
};
constexpr Bounds kAltitude_m{kLeastAltitude_m, kMostAltitude_m};
constexpr Bounds kTilt_deg{-kMostTilt_deg, kMostTilt_deg};
constexpr Bounds kMultiple{0.0, 1e6};

// A, or FIRST:LAST:STEP with both ends.
std::vector<double> axis_of(const std::string& option, const std::string& text, Bounds bounds) {
    const auto fail = [&] {
        throw InputError(
            "{}: found {}; allowed: a number or FIRST:LAST:STEP, from {} to {}, of up to 10001 "
            "values that end at LAST",
            option,
            text,
            bounds.least,
            bounds.most);
    };
    std::vector<double> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ':');) {
        std::size_t used = 0;
        try {
            parts.push_back(std::stod(part, &used));
        } catch (const std::exception&) {
            fail();
        }
        if (used != part.size()) fail();
    }
    const bool is_one = parts.size() == 1;
    if (!is_one && parts.size() != 3) fail();
    const double first = parts.front();
    const double last = is_one ? first : parts[1];
    if (!(first >= bounds.least && first <= last && last <= bounds.most)) fail();
    if (is_one || first == last) return {first};
    constexpr double kMostSteps = 10000.0;
    const double steps = (last - first) / parts[2];
    const double whole = std::round(steps);
    constexpr double kWhole = 1e-6;
    if (!(steps >= 1.0 - kWhole && whole <= kMostSteps) || std::abs(steps - whole) > kWhole) fail();
    std::vector<double> values;
    constexpr double kDigits = 1e9;
    for (int i = 0; i <= static_cast<int>(whole); ++i) {
        values.push_back(std::round((first + i * parts[2]) * kDigits) / kDigits);
    }
    return values;
}

std::vector<double> in_radians(std::vector<double> values_deg) {
    for (double& value : values_deg) value *= kRadiansPerDegree;
    return values_deg;
}

void require_few(const MapAxes& axes) {
    const std::size_t bins = bin_count(axes);
    if (bins <= kMostBins) return;
    throw InputError(
        "--altitude, --pitch, --roll, --water-multiple: found {} x {} x {} x {} = {} bins; "
        "allowed: up to {} in all",
        axes.altitude_m.size(),
        axes.pitch_rad.size(),
        axes.roll_rad.size(),
        axes.water_multiple.size(),
        bins,
        kMostBins);
}

}  // namespace

void add_axis_options(CLI::App& app, AxisTexts& texts) {
    constexpr const char* kSteps = "FIRST:LAST:STEP";
    app.add_option(kAltitudeNames, texts.altitude, "Altitudes in metres, such as 1:4:0.1")
        ->required()
        ->option_text(kSteps);
    app.add_option(kPitchNames, texts.pitch, "Pitches in degrees; by default the rig's")
        ->option_text(kSteps);
    app.add_option(kRollNames, texts.roll, "Rolls in degrees; by default the rig's")
        ->option_text(kSteps);
    app.add_option("--water-multiple",
                   texts.water,
                   "Multiples of the water's absorption; by default the rig's")
        ->option_text(kSteps);
}

MapAxes axes_of(const AxisTexts& texts, const Rig& rig) {
    MapAxes axes{.altitude_m = axis_of("--altitude", texts.altitude, kAltitude_m),
                 .pitch_rad = {rig.sled.pitch_rad},
                 .roll_rad = {rig.sled.roll_rad},
                 .water_multiple = {rig.water.multiple}};
    if (!texts.pitch.empty()) {
        axes.pitch_rad = in_radians(axis_of("--pitch", texts.pitch, kTilt_deg));
    }
    if (!texts.roll.empty()) {
        axes.roll_rad = in_radians(axis_of("--roll", texts.roll, kTilt_deg));
    }
    if (!texts.water.empty()) {
        axes.water_multiple = axis_of("--water-multiple", texts.water, kMultiple);
    }
    require_few(axes);
    return axes;
}

}  // namespace aphotic::cli
