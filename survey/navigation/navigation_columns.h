// SPDX-License-Identifier: BSD-3-Clause
//
// The meaning of a table's columns, by their names in the formats of surveys, ignoring case
// (formats.json): Aphotic's, oplab's, BIIGLE's and SQUIDLE+'s CSV, HabCam's .img, PANGAEA's tab
// files, and any table whose names are clear enough, with units if in doubt.
//
// The vehicle's place is read only on request: east and north in metres of any one frame, the
// heading clockwise from north, the depth below the sea level. x and y have no certain direction,
// and are used only if given for east and north.
//
// All are in metres and degrees. Heights above the sea level are never used: gps_altitude,
// SUB_altitude, pose.dep, depth, and PANGAEA's altitude [m].
//
// Sources: oplab_pipeline, auv_nav/sensors.py and tools/csv_tools.py, and its
// generate_nav_file_for_squidle.py; biigle/core, image metadata parser; oii, HabCam's metadata.
#pragma once

#include "survey/navigation/navigation.h"

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// A number of a pose, as in tables and tags.

// NaN if the field is unknown, by None or an empty cell; anything else that is not a number is a
// fault of the pose.
[[nodiscard]] double number_in(ImagePose& pose, std::string_view column, std::string_view field);

enum class NavigationField { Image, Time, Altitude, Pitch, Roll, East, North, Heading, Depth };
inline constexpr std::array<std::string_view, 9> kNavigationFields{"image",
                                                                   "time",
                                                                   "altitude_m",
                                                                   "pitch_deg",
                                                                   "roll_deg",
                                                                   "east_m",
                                                                   "north_m",
                                                                   "heading_deg",
                                                                   "depth_m"};

// The file's names of columns, by ours of kNavigationFields.
using ColumnNames = std::map<std::string, std::string>;

struct NavigationColumns {
    std::string format{};
    std::size_t count = 0;  // of all columns
    std::array<std::optional<std::size_t>, kNavigationFields.size()> places{};
    std::array<std::string, kNavigationFields.size()> names{};  // as in the header

    [[nodiscard]] std::optional<std::size_t> place(NavigationField field) const {
        return places.at(static_cast<std::size_t>(field));
    }
    [[nodiscard]] const std::string& name(NavigationField field) const {
        return names.at(static_cast<std::size_t>(field));
    }
    // Images are located by their times, since the table does not name them.
    [[nodiscard]] bool is_track() const { return !place(NavigationField::Image); }
};

// HabCam's .img has no header: these are its columns, in their order.
inline constexpr std::string_view kHabCamColumns =
    "imagename,lat,lon,head,pitch,roll,alt1,alt2,depth,s,t,o2,cdom,chlorophyll,backscatter,therm";

// formats.json: the column names of each format.
struct NavigationFormats {
    std::string_view name;
    std::string_view json;
};
[[nodiscard]] std::span<const NavigationFormats> navigation_formats();

struct HeaderRequest {
    std::string file{};  // file and line are for messages
    std::size_t line = 0;
    ColumnNames given{};
    AngleUnit angles_in = AngleUnit::Degrees;
    bool is_pangaeas = false;
    bool has_places = false;  // the vehicle's place is requested
};

// Empty if the columns, including the given ones, match no format. An InputError, which begins with
// file and line, if the unit in a column's name contradicts the expected one.
[[nodiscard]] std::optional<NavigationColumns> navigation_columns(
    const HeaderRequest& request, const std::vector<std::string>& header);

// The InputError for columns that match no format.
[[noreturn]] void refuse_header(const HeaderRequest& request,
                                const std::vector<std::string>& header);

}  // namespace aphotic
