// SPDX-License-Identifier: BSD-3-Clause
#include "cli/navigation_options.h"

#include "base/csv.h"
#include "base/error.h"
#include "cli/option_checks.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "survey/image_time.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace aphotic::cli {
namespace {

constexpr double kMostOffset_m = 1000.0;  // as a rig has it
constexpr double kMostClock_s = 1e10;     // a clock that began anew in 1970 is off by 2e9

// "altitude_m=alt [m],roll_deg=phi"
ColumnNames column_names(const std::string& text) {
    ColumnNames names;
    for (const std::string_view one : comma_fields(text)) {
        const std::size_t equals = one.find('=');
        const std::string ours(trimmed(one.substr(0, equals)));
        const bool is_ours =
            std::ranges::find(kNavigationFields, std::string_view(ours)) != kNavigationFields.end();
        if (!is_ours || equals == std::string_view::npos || equals + 1 == one.size()) {
            throw InputError("found '{}'; allowed: NAME=COLUMN, NAME one of {}",
                             one,
                             fmt::join(kNavigationFields, ", "));
        }
        names[ours] = std::string(trimmed(one.substr(equals + 1)));
    }
    return names;
}

// Refuses what `read` throws an InputError at.
template <typename Read>
CLI::Validator readable(const Read& read, const std::string& name) {
    return {[read](const std::string& text) {
                try {
                    static_cast<void>(read(text));
                    return std::string();
                } catch (const InputError& error) {
                    return std::string(error.what());
                }
            },
            name};
}

void add_columns(CLI::App& app, NavigationOptions& options) {
    app.add_option_function<std::string>(
           "--columns",
           [&options](const std::string& text) { options.columns = column_names(text); },
           "Take image, time, altitude_m, pitch_deg or roll_deg from other columns, such as "
           "'altitude_m=alt [m],roll_deg=phi'")
        ->option_text("NAME=COLUMN,...")
        ->check(readable(column_names, ""));
    app.add_option("--angles-in", options.angles_in, "Unit of pitch and roll: deg or rad")
        ->transform(word_of<AngleUnit>({{"deg", AngleUnit::Degrees}, {"rad", AngleUnit::Radians}}))
        ->type_name("deg|rad")
        ->default_str("deg");
}

bool time_mask(const std::string& mask) {
    require_time_mask(mask);
    return true;
}

void add_times(CLI::App& app, NavigationOptions& options) {
    app.add_option(
           "--image-time",
           options.time_mask,
           "Where images' names have their time, such as xxxYYYYMMDDxhhmmssxfff; by default "
           "EXIF, or HabCam's names")
        ->check(readable(time_mask, "MASK"));
    app.add_option("--clock-offset-s",
                   options.clock_offset_s,
                   "Add this many seconds to the images' times, to have the navigation's")
        ->check(in_range(-kMostClock_s, kMostClock_s).description(""))
        ->capture_default_str();
    app.add_option("--longest-gap-s",
                   options.longest_gap_s,
                   "Interpolate over time between lines up to this many seconds apart")
        ->check(positive())
        ->capture_default_str();
}

void add_altitude_meaning(CLI::App& app, NavigationOptions& options) {
    std::map<std::string, AltitudeIs> words;
    for (std::size_t i = 0; i < kAltitudeWords.size(); ++i)
        words[std::string(kAltitudeWords.at(i))] = static_cast<AltitudeIs>(i);
    app.add_option("--altitude-is",
                   options.altitude_is,
                   "What navigation's altitudes are: along the camera's axis, the vertical height, "
                   "or to the nearest floor; by default the rig's altitude_is, or axis")
        ->transform(word_of(words))
        ->type_name("axis|plumb|nearest");
    app.add_option("--altitude-offset-m",
                   options.altitude_offset_m,
                   "Add this to altitudes, in metres; by default the rig's altitude_offset_m, or 0")
        ->check(in_range(-kMostOffset_m, kMostOffset_m));
}

}  // namespace

CLI::Option* add_navigation_options(CLI::App& app, NavigationOptions& options) {
    const OptionGroup group(app, "Navigation");
    CLI::Option* nav =
        app.add_option("--nav",
                       options.source,
                       "Altitude, pitch and roll of each image: a table of Aphotic's, oplab's, "
                       "BIIGLE's, SQUIDLE+'s or HabCam's form, or of poses over time; or the word "
                       "tags, for HabCam's tags in the images")
            ->type_name("FILE");
    add_columns(app, options);
    add_times(app, options);
    add_altitude_meaning(app, options);
    for (const char* name : {"--columns",
                             "--angles-in",
                             "--image-time",
                             "--clock-offset-s",
                             "--longest-gap-s",
                             "--altitude-is",
                             "--altitude-offset-m"})
        app.get_option(name)->needs(nav);
    return nav;
}

Navigation read_navigation_with(const std::string& rig,
                                NavigationOptions options,
                                const std::vector<ImageFile>& files) {
    options.jobs = static_cast<std::size_t>(all_cores());
    if (rig.empty()) return read_navigation(options, files, nullptr);
    const Rig read = read_rig_as_set(rig);
    return read_navigation(options, files, &read);
}

void print_navigation(const std::optional<Navigation>& navigation) {
    if (!navigation || !navigation->notes()) return;
    say("  navigation: {}\n", words_of(*navigation->notes()));
}

}  // namespace aphotic::cli
