// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation_columns.h"

#include "base/error.h"
#include "base/nearest.h"
#include "base/printable.h"
#include "base/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace aphotic {
namespace {

using Header = std::vector<std::string_view>;

struct KnownFormat {
    std::string_view name;
    // In lower case, the first that is there counts.
    std::array<std::vector<std::string_view>, kNavigationFields.size()> columns;
};

const std::vector<KnownFormat>& known_formats() {
    static const std::vector<KnownFormat> kFormats{
        {"Aphotic's CSV",
         {{{"image"},
           {"timestamp [s]", "timestamp", "time", "datetime"},
           {"altitude_m"},
           {"pitch_deg"},
           {"roll_deg"}}}},
        {"oplab's CSV",
         {{{"relative_path"},
           {"timestamp [s]"},
           {"altitude [m]"},
           {"pitch [deg]"},
           {"roll [deg]"}}}},
        {"BIIGLE's CSV",
         {{{"filename", "file"},
           {"taken_at", "sub_datetime"},
           {"distance_to_ground", "sub_distance"},
           {},
           {}}}},
        {"SQUIDLE+'s CSV",
         {{{"key"}, {"timestamp_start"}, {"pose.alt"}, {"pose.data.pitch"}, {"pose.data.roll"}}}},
        {"HabCam's .img", {{{"imagename"}, {}, {"alt1"}, {"pitch"}, {"roll"}}}}};
    return kFormats;
}

std::optional<std::size_t> column_named(const Header& header, std::string_view wanted) {
    const auto same = [&](std::string_view column) {
        return lower_case(std::string(column)) == lower_case(std::string(wanted));
    };
    const auto found = std::ranges::find_if(header, same);
    if (found == header.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.begin());
}

std::string is_it(std::string_view wanted, const Header& header) {
    const std::vector<std::string> known(header.begin(), header.end());
    const std::string near = nearest_name(wanted, known);
    return near.empty() ? "" : fmt::format(" (is it '{}'?)", near);
}

// Those of --columns.
NavigationColumns given_columns(const std::string& file,
                                std::size_t line,
                                const Header& header,
                                const ColumnNames& given) {
    NavigationColumns columns;
    for (std::size_t field = 0; field < kNavigationFields.size(); ++field) {
        const auto name = given.find(std::string(kNavigationFields.at(field)));
        if (name == given.end()) continue;
        columns.places.at(field) = column_named(header, name->second);
        if (columns.places.at(field)) continue;
        fail_at_line(file,
                     line,
                     "found the columns {}; needed by --columns: '{}'{}",
                     fmt::join(header, ","),
                     name->second,
                     is_it(name->second, header));
    }
    return columns;
}

NavigationColumns with_format(NavigationColumns columns,
                              const KnownFormat& format,
                              const Header& header) {
    columns.format = format.name;
    for (std::size_t field = 0; field < kNavigationFields.size(); ++field) {
        for (const std::string_view name : format.columns.at(field)) {
            auto& place = columns.places.at(field);
            if (!place) place = column_named(header, name);
        }
    }
    return columns;
}

bool has_pose_and_name(const NavigationColumns& columns) {
    return columns.place(NavigationField::Altitude) &&
           (columns.place(NavigationField::Image) || columns.place(NavigationField::Time));
}

// The format with most of the columns that are its own: image, else altitude, else time, in which
// --columns may have put others in the place of the rest.
std::optional<NavigationColumns> recognised(const NavigationColumns& given, const Header& header) {
    using Wanted = std::vector<NavigationField>;
    using enum NavigationField;
    for (const Wanted& wanted :
         {Wanted{Image, Altitude}, Wanted{Time, Altitude}, Wanted{Image}, Wanted{Altitude}, {}}) {
        for (const KnownFormat& format : known_formats()) {
            const NavigationColumns own = with_format({}, format, header);
            const bool is_it = std::ranges::all_of(
                wanted, [&](auto field) { return own.place(field).has_value(); });
            NavigationColumns columns = with_format(given, format, header);
            if (is_it && has_pose_and_name(columns)) return columns;
        }
    }
    return std::nullopt;
}

[[noreturn]] void refuse_header(const std::string& file,
                                std::size_t line,
                                const Header& header,
                                const NavigationColumns& given) {
    constexpr std::array<std::string_view, 5> kOverTheSea{
        "gps_altitude", "sub_altitude", "image-altitude-meters", "pose.dep", "depth"};
    const NavigationColumns ours = with_format(given, known_formats().front(), header);
    const bool has_altitude = ours.place(NavigationField::Altitude).has_value();
    const std::string_view needed = has_altitude ? "image" : "altitude_m";
    std::string sea;
    for (const std::string_view name : kOverTheSea) {
        const auto place = column_named(header, name);
        if (has_altitude || !place || !sea.empty()) continue;
        sea = fmt::format("; '{}' is relative to the sea level", header[*place]);
    }
    fail_at_line(file,
                 line,
                 "found the columns {}; needed: '{}'{}{}, or --columns {}=NAME{}",
                 fmt::join(header, ","),
                 needed,
                 has_altitude ? " or 'timestamp'" : "",
                 is_it(needed, header),
                 needed,
                 sea);
}

// Of an angle under another name, the rig's would be taken and nobody be told.
void require_known_angles(const std::string& file,
                          std::size_t line,
                          const Header& header,
                          const NavigationColumns& columns) {
    using enum NavigationField;
    for (const auto& [field, word] : {std::pair{Pitch, "pitch"}, std::pair{Roll, "roll"}}) {
        if (columns.place(field)) continue;
        const std::string_view ours = kNavigationFields.at(static_cast<std::size_t>(field));
        for (const std::string_view column : header) {
            if (!lower_case(std::string(column)).starts_with(word)) continue;
            fail_at_line(file,
                         line,
                         "found the column '{}'; allowed: '{}', or --columns {}='{}'",
                         column,
                         ours,
                         ours,
                         column);
        }
    }
}

}  // namespace

NavigationColumns navigation_columns(const std::string& file,
                                     std::size_t line,
                                     const Header& header,
                                     const ColumnNames& given) {
    const NavigationColumns told = given_columns(file, line, header, given);
    std::optional<NavigationColumns> columns = recognised(told, header);
    if (!columns) refuse_header(file, line, header, told);
    // One of them says where the images are; which, --columns may choose.
    auto& [image, time, altitude, pitch, roll] = columns->places;
    if (image && told.place(NavigationField::Time) && !told.place(NavigationField::Image))
        image.reset();
    if (image) time.reset();
    require_known_angles(file, line, header, *columns);
    columns->count = header.size();
    for (std::size_t field = 0; field < kNavigationFields.size(); ++field) {
        const auto place = columns->places.at(field);
        if (!place) continue;
        const std::string_view name = header[*place];
        columns->names.at(field) = std::string(name);
        if (std::ranges::count(header, name) > 1)
            fail_at_line(file, line, "the column '{}' stands twice", excerpt(name));
    }
    return *columns;
}

}  // namespace aphotic
