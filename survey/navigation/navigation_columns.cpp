// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/navigation_columns.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/nearest.h"
#include "base/number.h"
#include "base/printable.h"
#include "base/words.h"
#include "rig/beam/photometric_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace aphotic {

namespace {

// How loggers, databases and spreadsheets write an unknown number, besides NaN itself.
bool is_unknown(std::string_view field) {
    static constexpr std::array<std::string_view, 8> kUnknown{
        "", "-", "na", "n/a", "#n/a", "null", "none", "1.#qnan"};
    return std::ranges::find(kUnknown, lower_case(std::string(field))) != kUnknown.end();
}

// 2,15, as spreadsheets write it in half of Europe.
bool has_decimal_comma(std::string_view field) {
    const std::size_t comma = field.find(',');
    return comma != std::string_view::npos && comma > 0 && comma + 1 < field.size() &&
           field.find_first_not_of("+-0123456789eE,") == std::string_view::npos;
}

}  // namespace

double number_in(ImagePose& pose, std::string_view column, std::string_view field) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (is_unknown(field)) return kNone;
    const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
    if (const auto number = read_number<double>(digits)) return *number;
    if (pose.fault.empty()) {
        pose.fault = fmt::format("{}: found {}; allowed: a number{}",
                                 column,
                                 shown_word(field),
                                 has_decimal_comma(field) ? " with a decimal point" : "");
    }
    return kNone;
}

namespace {

using Header = std::vector<std::string>;

struct KnownFormat {
    std::string name;
    // In lower case; the first one present is used.
    std::array<std::vector<std::string>, kNavigationFields.size()> columns;
};

std::vector<KnownFormat> formats_in(std::string_view json) {
    std::vector<KnownFormat> formats;
    for (const nlohmann::json& one : nlohmann::json::parse(json)) {
        KnownFormat format{.name = one.at("format").get<std::string>(), .columns = {}};
        for (std::size_t field = 0; field < kNavigationFields.size(); ++field)
            format.columns.at(field) =
                one.value(std::string(kNavigationFields.at(field)), std::vector<std::string>{});
        formats.push_back(std::move(format));
    }
    return formats;
}

// PANGAEA's comes last and separately, since its altitude [m], for one, is above sea level.
std::span<const KnownFormat> formats_of(const HeaderRequest& request) {
    static const std::vector<KnownFormat> kFormats = formats_in(navigation_formats().front().json);
    const std::span<const KnownFormat> all(kFormats);
    return request.is_pangaeas ? all.last(1) : all.first(all.size() - 1);
}

std::optional<std::size_t> column_named(const Header& header, std::string_view wanted) {
    const auto same = [&](const std::string& column) {
        return lower_case(column) == lower_case(std::string(wanted));
    };
    const auto found = std::ranges::find_if(header, same);
    if (found == header.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.begin());
}

std::string is_it(std::string_view wanted, const Header& header) {
    const std::string near = nearest_name(wanted, header);
    return near.empty() ? "" : fmt::format(" (is it '{}'?)", printable(near));
}

// Those of --columns that are present.
NavigationColumns given_columns(const Header& header, const ColumnNames& given) {
    NavigationColumns columns;
    for (std::size_t field = 0; field < kNavigationFields.size(); ++field) {
        const auto name = given.find(std::string(kNavigationFields.at(field)));
        if (name != given.end()) columns.places.at(field) = column_named(header, name->second);
    }
    return columns;
}

NavigationColumns with_format(NavigationColumns columns,
                              const KnownFormat& format,
                              const Header& header) {
    columns.format = format.name;
    for (std::size_t field = 0; field < kNavigationFields.size(); ++field) {
        for (const std::string& name : format.columns.at(field)) {
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

// The format with most of its own columns present: image, otherwise altitude, otherwise time, since
// --columns may have replaced the rest.
std::optional<NavigationColumns> recognised(const NavigationColumns& given,
                                            std::span<const KnownFormat> formats,
                                            const Header& header) {
    using Wanted = std::vector<NavigationField>;
    using enum NavigationField;
    for (const Wanted& wanted :
         {Wanted{Image, Altitude}, Wanted{Time, Altitude}, Wanted{Image}, Wanted{Altitude}, {}}) {
        for (const KnownFormat& format : formats) {
            const NavigationColumns own = with_format({}, format, header);
            const bool is_it = std::ranges::all_of(
                wanted, [&](auto field) { return own.place(field).has_value(); });
            NavigationColumns columns = with_format(given, format, header);
            if (is_it && has_pose_and_name(columns)) return columns;
        }
    }
    return std::nullopt;
}

// If an angle had another name, the rig's would be used silently.
void require_known_angles(const HeaderRequest& request,
                          const Header& header,
                          const NavigationColumns& columns) {
    using enum NavigationField;
    for (const auto& [field, word] : {std::pair{Pitch, "pitch"}, std::pair{Roll, "roll"}}) {
        if (columns.place(field)) continue;
        const std::string_view ours = kNavigationFields.at(static_cast<std::size_t>(field));
        for (const std::string& column : header) {
            if (!lower_case(column).starts_with(word)) continue;
            fail_at_line(request.file,
                         request.line,
                         "found the column '{}'; allowed: '{}', or --columns {}='{}'",
                         printable(column),
                         ours,
                         ours,
                         printable(column));
        }
    }
}

// The unit at the end of a column's name, as in "pitch [deg]", "altitude (cm)" and "roll_rad".
std::string unit_in(std::string_view column) {
    const bool has_bracket = column.ends_with(']') || column.ends_with(')');
    if (has_bracket) column.remove_suffix(1);
    const std::size_t start = column.find_last_of(has_bracket ? "[(" : "_");
    if (start == std::string_view::npos) return "";
    return lower_case(std::string(trimmed(column.substr(start + 1))));
}

// The name of a column given by --columns may state a unit other than the expected one.
void require_units(const HeaderRequest& request, const NavigationColumns& columns) {
    static const std::set<std::string> kLengths{
        "mm", "cm", "dm", "km", "ft", "feet", "foot", "inch", "inches", "fathoms", "fm"};
    static const std::set<std::string> kRadians{"rad", "rads", "radian", "radians"};
    using enum NavigationField;
    const auto fail = [&](NavigationField field, std::string_view allowed) {
        const std::string& name = columns.name(field);
        fail_at_line(request.file,
                     request.line,
                     "the column '{}' is in {}; allowed: {}",
                     printable(name),
                     printable(unit_in(name)),
                     allowed);
    };
    for (const NavigationField length : {Altitude, East, North, Depth})
        if (kLengths.contains(unit_in(columns.name(length)))) fail(length, "metres");
    if (request.angles_in == AngleUnit::Radians) return;
    for (const NavigationField angle : {Pitch, Roll, Heading}) {
        if (kRadians.contains(unit_in(columns.name(angle))))
            fail(angle, "degrees, or --angles-in rad");
    }
}

}  // namespace

void refuse_header(const HeaderRequest& request, const Header& header) {
    for (const auto& [ours, name] : request.given) {
        if (column_named(header, name)) continue;
        fail_at_line(request.file,
                     request.line,
                     "found the columns {}; needed by --columns: '{}'{}",
                     fmt::join(header, ","),
                     name,
                     is_it(name, header));
    }
    std::vector<std::string_view> over_the_sea{
        "gps_altitude", "sub_altitude", "image-altitude-meters", "pose.dep", "depth"};
    if (request.is_pangaeas) over_the_sea.emplace_back("altitude [m]");
    const NavigationColumns ours =
        with_format(given_columns(header, request.given), formats_of(request).front(), header);
    const bool has_altitude = ours.place(NavigationField::Altitude).has_value();
    const std::string_view needed = has_altitude ? "image" : "altitude_m";
    std::string sea;
    for (const std::string_view name : over_the_sea) {
        const auto place = column_named(header, name);
        if (has_altitude || !place || !sea.empty()) continue;
        sea = fmt::format("; '{}' is relative to the sea level", printable(header[*place]));
    }
    fail_at_line(request.file,
                 request.line,
                 "found the columns {}{}; needed: '{}'{}{}, or --columns {}=NAME{}",
                 fmt::join(header, ","),
                 request.is_pangaeas ? ", of PANGAEA's tab file" : "",
                 needed,
                 has_altitude ? " or 'timestamp'" : "",
                 is_it(needed, header),
                 needed,
                 sea);
}

std::optional<NavigationColumns> navigation_columns(const HeaderRequest& request,
                                                    const Header& header) {
    for (const auto& [ours, name] : request.given) {
        if (!column_named(header, name)) return std::nullopt;
    }
    const NavigationColumns given = given_columns(header, request.given);
    std::optional<NavigationColumns> columns = recognised(given, formats_of(request), header);
    if (!columns) return columns;
    // One of them identifies the images; --columns may select which.
    auto& image = columns->places[0];
    auto& time = columns->places[1];
    constexpr auto kFirstOfPlace = static_cast<std::ptrdiff_t>(NavigationField::East);
    if (!request.has_places)
        std::copy(given.places.begin() + kFirstOfPlace,
                  given.places.end(),
                  columns->places.begin() + kFirstOfPlace);
    if (image && given.place(NavigationField::Time) && !given.place(NavigationField::Image))
        image.reset();
    if (image) time.reset();
    require_known_angles(request, header, *columns);
    columns->count = header.size();
    std::vector<std::string> names;
    for (const std::string& name : header) names.push_back(lower_case(name));
    for (std::size_t field = 0; field < kNavigationFields.size(); ++field) {
        const auto place = columns->places.at(field);
        if (!place) continue;
        columns->names.at(field) = header[*place];
        if (std::ranges::count(names, names[*place]) > 1) {
            fail_at_line(
                request.file, request.line, "duplicate column '{}'", printable(header[*place]));
        }
    }
    require_units(request, *columns);
    return columns;
}

}  // namespace aphotic
