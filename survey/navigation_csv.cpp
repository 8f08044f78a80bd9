// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation_csv.h"

#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/printable.h"
#include "survey/navigation_cell.h"
#include "survey/time_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace aphotic {
namespace {

constexpr std::size_t kEicFields = 4;

using enum NavigationField;
using Fields = std::vector<std::string_view>;

// Where the field that begins at `start` ends: at a comma outside of its quotes.
std::size_t field_end(std::string_view line, std::size_t start) {
    std::size_t from = line.find_first_not_of(kBlanks, start);
    if (from == std::string_view::npos || line[from] != '"') return line.find(',', start);
    const std::size_t close = line.find('"', from + 1);
    return line.find(',', close == std::string_view::npos ? start : close);
}

Fields unquoted_fields(std::string_view line) {
    Fields fields;
    for (std::size_t start = 0; start <= line.size();) {
        const std::size_t end = std::min(field_end(line, start), line.size());
        std::string_view field = trimmed(line.substr(start, end - start));
        const bool is_quoted = field.size() > 1 && field.front() == '"' && field.back() == '"';
        fields.push_back(is_quoted ? trimmed(field.substr(1, field.size() - 2)) : field);
        start = end + 1;
    }
    return fields;
}

Fields blank_fields(std::string_view line) {
    Fields fields;
    for (std::size_t start = line.find_first_not_of(kBlanks); start != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kBlanks, start), line.size());
        fields.push_back(line.substr(start, end - start));
        start = line.find_first_not_of(kBlanks, end);
    }
    return fields;
}

// How lines are taken apart, and what their fields say.
struct Layout {
    NavigationColumns columns;
    bool has_commas = true;
};

Layout eic_layout() {
    return {.columns = {.format = "HabCam's .eic",
                        .count = kEicFields,
                        .places = {0, std::nullopt, 1, 2, 3},
                        .names = {"image", "", "altitude_m", "pitch_deg", "roll_deg"}},
            .has_commas = false};
}

// Sixteen fields, of which latitude to roll are numbers.
bool is_habcam_img(const Fields& fields) {
    if (fields.size() != kHabCamColumns.size()) return false;
    return std::ranges::all_of(fields.begin() + 1, fields.begin() + 6, [](std::string_view field) {
        ImagePose none;
        static_cast<void>(number_in(none, "", field));
        return none.fault.empty();
    });
}

ImagePose pose_in(const Layout& layout,
                  const Fields& fields,
                  ImagePose pose,
                  double radians_per_unit) {
    const NavigationColumns& columns = layout.columns;
    const auto number = [&](NavigationField field) {
        return number_in(pose, columns.name(field), fields[*columns.place(field)]);
    };
    if (fields.size() != columns.count) {
        pose.fault =
            fmt::format("found {} fields; allowed: {}",
                        fields.size(),
                        layout.has_commas ? fmt::format("{}, as in the header row", columns.count)
                                          : "4: image, altitude, pitch, roll");
        return pose;
    }
    pose.sled.altitude_m = number(Altitude);
    if (columns.place(Pitch)) pose.sled.pitch_rad = number(Pitch) * radians_per_unit;
    if (columns.place(Roll)) pose.sled.roll_rad = number(Roll) * radians_per_unit;
    return pose;
}

void add_time(NavigationRow& row, const NavigationColumns& columns, const Fields& fields) {
    if (!row.pose.fault.empty()) return;
    const std::string_view text = fields[*columns.place(Time)];
    const auto time_s = unix_time_s(text);
    if (time_s) row.time_s = *time_s;
    if (time_s) return;
    row.pose.fault = fmt::format(
        "{}: found '{}'; allowed: seconds since 1970, or a time such as 2024-03-09 12:34:56.789",
        columns.name(Time),
        excerpt(text));
}

}  // namespace

NavigationTable parse_navigation_csv(const std::string& name,
                                     std::string_view text,
                                     const Sled& rig_sled,
                                     const ColumnNames& given,
                                     AngleUnit angles_in) {
    const double radians_per_unit = angles_in == AngleUnit::Degrees ? kRadiansPerDegree : 1.0;
    NavigationTable table;
    std::optional<Layout> layout;
    table.lines = for_each_line(text, [&](std::size_t line, std::string_view words) {
        const std::string_view content = trimmed(words);
        // Spreadsheets end a table with rows of commas alone.
        const bool is_empty = content.find_first_not_of(',') == std::string_view::npos;
        if (is_empty || content.front() == '#') return;
        const bool has_commas =
            layout ? layout->has_commas : content.find(',') != std::string_view::npos;
        const Fields fields = has_commas ? unquoted_fields(content) : blank_fields(content);
        if (!layout && !has_commas && content.find(';') != std::string_view::npos)
            fail_at_line(name, line, "found semicolons between fields; allowed: commas");
        if (!layout && !has_commas && content.find('\t') != std::string_view::npos &&
            fields.size() != kEicFields)
            fail_at_line(name, line, "found tabs between fields; allowed: commas");
        if (!layout && !has_commas) {
            if (!given.empty())
                fail_at_line(name, line, "found no header row; needed by --columns");
            layout = eic_layout();
        }
        if (!layout) {
            const bool is_img = is_habcam_img(fields);
            const Fields header =
                is_img ? Fields(kHabCamColumns.begin(), kHabCamColumns.end()) : fields;
            layout = Layout{.columns = navigation_columns(name, line, header, given)};
            if (!is_img) return;
        }
        const NavigationColumns& columns = layout->columns;
        ImagePose pose{.sled = rig_sled, .line = line};
        if (const auto image = columns.place(Image); image && *image < fields.size())
            pose.image = std::string(fields[*image]);
        NavigationRow row{.pose = pose_in(*layout, fields, std::move(pose), radians_per_unit)};
        if (columns.is_track()) add_time(row, columns, fields);
        table.rows.push_back(std::move(row));
    });
    if (layout) table.columns = layout->columns;
    const bool is_of_use = std::ranges::any_of(table.rows, [&](const NavigationRow& row) {
        return table.columns.is_track() || !row.pose.image.empty();
    });
    if (!is_of_use) {
        fail_at_line(name,
                     table.lines + 1,
                     "the file ends without a line of {}",
                     layout && table.columns.is_track() ? "a pose" : "an image");
    }
    return table;
}

}  // namespace aphotic
