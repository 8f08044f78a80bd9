// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation_csv.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/nearest.h"
#include "base/words.h"
#include "survey/navigation_ifdo.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

constexpr std::string_view kImage = "image";
constexpr std::string_view kAltitude = "altitude_m";
constexpr std::string_view kPitch = "pitch_deg";
constexpr std::string_view kRoll = "roll_deg";

std::vector<std::string_view> unquoted_fields(std::string_view line) {
    std::vector<std::string_view> fields = comma_fields(line);
    for (std::string_view& field : fields) {
        const bool is_quoted = field.size() > 1 && field.front() == '"' && field.back() == '"';
        if (is_quoted) field = trimmed(field.substr(1, field.size() - 2));
    }
    return fields;
}

std::vector<std::string_view> blank_fields(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t start = line.find_first_not_of(kBlanks); start != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kBlanks, start), line.size());
        fields.push_back(line.substr(start, end - start));
        start = line.find_first_not_of(kBlanks, end);
    }
    return fields;
}

// Which field of a line holds what.
struct ColumnLayout {
    bool has_commas = false;
    std::size_t fields = 4;
    std::size_t image = 0;
    std::size_t altitude = 1;
    std::optional<std::size_t> pitch = 2;
    std::optional<std::size_t> roll = 3;
};

std::optional<std::size_t> column_named(const std::vector<std::string_view>& columns,
                                        std::string_view wanted) {
    const auto found = std::ranges::find(columns, wanted);
    if (found == columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - columns.begin());
}

ColumnLayout layout_of(const std::string& name,
                       std::size_t line,
                       const std::vector<std::string_view>& columns) {
    for (const std::string_view column : {kImage, kAltitude, kPitch, kRoll}) {
        if (std::ranges::count(columns, column) > 1) {
            fail_at_line(name, line, "the column '{}' stands twice", column);
        }
    }
    for (const std::string_view needed : {kImage, kAltitude}) {
        if (column_named(columns, needed)) continue;
        const std::vector<std::string> known(columns.begin(), columns.end());
        const std::string near = nearest_name(needed, known);
        fail_at_line(name,
                     line,
                     "found the columns {}; needed: '{}'{}; allowed besides: {}, {}",
                     fmt::join(columns, ","),
                     needed,
                     near.empty() ? "" : fmt::format(" (is it '{}'?)", near),
                     kPitch,
                     kRoll);
    }
    // Of an optional one under another name, the rig's would be taken and nobody be told.
    for (const auto& [wanted, word] : {std::pair{kPitch, "pitch"}, std::pair{kRoll, "roll"}}) {
        if (column_named(columns, wanted)) continue;
        for (const std::string_view column : columns) {
            if (!column.starts_with(word)) continue;
            fail_at_line(name, line, "found the column '{}'; allowed: '{}'", column, wanted);
        }
    }
    return {.has_commas = true,
            .fields = columns.size(),
            .image = *column_named(columns, kImage),
            .altitude = *column_named(columns, kAltitude),
            .pitch = column_named(columns, kPitch),
            .roll = column_named(columns, kRoll)};
}

// What loggers, databases and spreadsheets write when they know no number, besides NaN itself.
bool is_unknown(std::string_view field) {
    static constexpr std::array<std::string_view, 8> kUnknown{
        "", "-", "na", "n/a", "#n/a", "null", "none", "1.#qnan"};
    return std::ranges::find(kUnknown, lower_case(std::string(field))) != kUnknown.end();
}

// NaN when there is none; what is neither is a fault of the pose.
double number_in(ImagePose& pose, std::string_view column, std::string_view field) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (is_unknown(field)) return kNone;
    const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
    double number = 0.0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, number);
    if (error == std::errc() && stop == end) return number;
    if (pose.fault.empty()) {
        pose.fault = fmt::format("{}: found '{}'; allowed: a number", column, field);
    }
    return kNone;
}

ImagePose pose_in(std::size_t line,
                  const ColumnLayout& layout,
                  const std::vector<std::string_view>& fields,
                  const Sled& rig_sled) {
    ImagePose pose{.sled = rig_sled, .line = line};
    if (layout.image < fields.size()) pose.image = std::string(fields[layout.image]);
    if (fields.size() != layout.fields) {
        pose.fault =
            fmt::format("found {} fields; allowed: {}",
                        fields.size(),
                        layout.has_commas ? fmt::format("{}, as in the header row", layout.fields)
                                          : "4: image, altitude, pitch, roll");
        return pose;
    }
    pose.sled.altitude_m = number_in(pose, kAltitude, fields[layout.altitude]);
    if (layout.pitch) {
        pose.sled.pitch_rad = number_in(pose, kPitch, fields[*layout.pitch]) * kRadiansPerDegree;
    }
    if (layout.roll) {
        pose.sled.roll_rad = number_in(pose, kRoll, fields[*layout.roll]) * kRadiansPerDegree;
    }
    return pose;
}

}  // namespace

Navigation parse_navigation_csv(const std::string& name,
                                std::string_view text,
                                const Sled& rig_sled) {
    std::vector<ImagePose> poses;
    ToldAngles told;
    std::optional<ColumnLayout> layout;
    const std::size_t lines = for_each_line(text, [&](std::size_t line, std::string_view words) {
        const std::string_view content = trimmed(words);
        // Spreadsheets end a table with rows of commas alone.
        const bool is_empty = content.find_first_not_of(',') == std::string_view::npos;
        if (is_empty || content.front() == '#') return;
        const bool has_commas = content.find(',') != std::string_view::npos;
        if (!layout && has_commas) {
            layout = layout_of(name, line, unquoted_fields(content));
            told = {.pitch = layout->pitch.has_value(), .roll = layout->roll.has_value()};
            return;
        }
        if (!layout) layout = ColumnLayout{};
        const auto fields = layout->has_commas ? unquoted_fields(content) : blank_fields(content);
        poses.push_back(pose_in(line, *layout, fields, rig_sled));
    });
    Navigation navigation(name, poses, told);
    if (navigation.size() == 0)
        fail_at_line(name, lines + 1, "the file ends without a line of an image");
    return navigation;
}

Navigation read_navigation_csv(const std::filesystem::path& file, const Sled& rig_sled) {
    const std::string text = read_text_file(file);
    return is_ifdo(text) ? parse_navigation_ifdo(file.string(), text, rig_sled)
                         : parse_navigation_csv(file.string(), text, rig_sled);
}

}  // namespace aphotic
