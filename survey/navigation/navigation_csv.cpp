// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/navigation_csv.h"

#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/printable.h"
#include "rig/beam/photometric_text.h"
#include "survey/navigation/table_text.h"
#include "survey/navigation/time_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace aphotic {

namespace {

// Poses from stereo_pose_est.data of the Australian Centre for Field Robotics (ACFR), from the AUV
// Sirius and similar ones: fifteen words per line, without a header,
//
//   identifier time latitude longitude X Y Z phi theta psi left right altitude radius cross-over
//
// Each line describes two images, left and right. X, Y and Z are metres north and east of the
// file's origin, and down. phi, theta and psi (radians) turn north, east and down, in this order of
// axes, into the stereo frame: X right in the image, Y to its bottom, Z along the axis. So the
// downward direction has these parts in the camera's own frame, whose x points to the image's top
// (rig/vehicle_pose.h):
//
//   (x, y, z) = (-cos theta sin phi, -sin theta, cos theta cos phi)
//   pitch = -asin x        roll = atan2(y, z)
//
// and the image's top points to
//
//   north = sin psi cos phi - cos psi sin theta sin phi
//   east  = -cos psi cos phi - sin psi sin theta sin phi
//
// phi = 0.0873, theta = 0: pitch 5.002 degrees, roll 0. The altitude is the vehicle's, and 0 where
// its altimeter lost the floor.
//
// Source: the comments that seabed_slam and oplab_pipeline (auv_nav, parse_acfr_stereo_pose.py)
// write into these files.
enum AcfrWord : std::size_t {
    kX = 4,
    kY = 5,
    kZ = 6,
    kPhi = 7,
    kTheta = 8,
    kPsi = 9,
    kLeft = 10,
    kRight = 11,
    kAltitude = 12
};
constexpr std::size_t kAcfrWords = 15;

bool is_numeric_word(std::string_view word) {
    ImagePose none;
    static_cast<void>(number_in(none, "", word));
    return none.fault.empty();
}

// Fifteen words, all numbers except the two names.
bool is_acfr_line(const std::vector<std::string>& words) {
    if (words.size() != kAcfrWords) return false;
    for (std::size_t i = 0; i < kAcfrWords; ++i) {
        const bool is_name = i == kLeft || i == kRight;
        if (is_name == is_numeric_word(words[i])) return false;
    }
    return true;
}

// For any line; one that is not of this kind is a fault of the poses.
std::array<ImagePose, 2> acfr_poses(const std::vector<std::string>& words, std::size_t line) {
    ImagePose pose{.line = line};
    if (words.size() != kAcfrWords) {
        pose.fault = fmt::format("found {} fields; allowed: {}", words.size(), kAcfrWords);
    } else {
        const double phi = number_in(pose, "X-axis Euler angle", words[kPhi]);
        const double theta = number_in(pose, "Y-axis Euler angle", words[kTheta]);
        ImagePose unsaid;  // users of the place report what is missing
        const auto of_place = [&](AcfrWord word) { return number_in(unsaid, "", words[word]); };
        const double psi = of_place(kPsi);
        const double tilt = std::sin(theta) * std::sin(phi);
        const double north = std::sin(psi) * std::cos(phi) - std::cos(psi) * tilt;
        const double east = -std::cos(psi) * std::cos(phi) - std::sin(psi) * tilt;
        pose.place = {.east_m = of_place(kY),
                      .north_m = of_place(kX),
                      .heading_rad = std::atan2(east, north),
                      .depth_m = of_place(kZ)};
        pose.sled = {.altitude_m = number_in(pose, "altitude", words[kAltitude]),
                     .pitch_rad = std::asin(std::cos(theta) * std::sin(phi)),
                     .roll_rad = std::atan2(-std::sin(theta), std::cos(theta) * std::cos(phi))};
    }
    std::array<ImagePose, 2> poses{pose, pose};
    if (words.size() > kLeft) poses[0].image = words[kLeft];
    if (words.size() > kRight) poses[1].image = words[kRight];
    return poses;
}

using enum NavigationField;
using Fields = std::vector<std::string>;

// Separators, with commas before those that may occur within a name.
constexpr std::array kSeparators{',', ';', '\t', kByBlanks};

// How lines are split, and the meaning of their fields.
struct Layout {
    NavigationColumns columns{};
    char separator = ',';
    bool has_header = false;
    bool is_acfrs = false;
};

// HabCam's .eic: image, altitude, pitch, roll.
constexpr std::size_t kEicFields = 4;

Layout eic_layout() {
    return {.columns = {.format = "HabCam's .eic",
                        .count = kEicFields,
                        .places = {0, std::nullopt, 1, 2, 3},
                        .names = {"image", "", "altitude_m", "pitch_deg", "roll_deg"}},
            .separator = kByBlanks};
}

// Matisse's .dim2: dive, date, time, source, format, name, latitude, longitude, depth, altitude,
// yaw, roll, pitch, and more. Source: IfremerUnderwater/Matisse, NavTools/dim2.cpp, and
// OpticalMapping/mosaic_descriptor.cpp, which turns by Ry(pitch) Rx(roll) with z down.
Layout dim2_layout(std::size_t count) {
    return {.columns = {.format = "Matisse's .dim2",
                        .count = count,
                        .places = {5, std::nullopt, 9, 12, 11},
                        .names = {"name", "", "altitude", "pitch", "roll"}},
            .separator = ';'};
}

Layout acfr_layout() {
    return {.columns = {.format = "ACFR's stereo_pose_est.data",
                        .places = {0, std::nullopt, 0, 0, 0},
                        .names = {"left, right", "", "altitude", "X angle", "Y angle"}},
            .separator = kByBlanks,
            .is_acfrs = true};
}

bool are_numbers(const Fields& fields, std::size_t first, std::size_t count) {
    const auto begin = fields.begin() + static_cast<std::ptrdiff_t>(first);
    return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(count), is_numeric_word);
}

// Latitude to roll are numbers.
bool is_habcam_img(const Fields& fields) {
    return fields.size() == comma_fields(kHabCamColumns).size() && are_numbers(fields, 1, 5);
}

// A header row of as many words has no number; a corrupted line retains one.
bool is_eic(const Fields& fields) {
    return fields.size() == kEicFields &&
           (are_numbers(fields, 1, 1) || are_numbers(fields, 2, 1) || are_numbers(fields, 3, 1));
}

// Its date is 31/12/2018; latitude to pitch are numbers.
bool is_dim2(const Fields& fields) {
    constexpr std::size_t kLeast = 13;
    if (fields.size() < kLeast) return false;
    const std::string& date = fields[1];
    return date.size() == 10 && date[2] == '/' && date[5] == '/' && are_numbers(fields, 6, 7);
}

std::string count_fault(const Layout& layout, std::size_t found) {
    const std::size_t count = layout.columns.count;
    if (layout.has_header)
        return fmt::format("found {} fields; allowed: {}, as in the header row", found, count);
    return fmt::format("found {} fields; allowed: {}{}",
                       found,
                       count,
                       count == kEicFields ? ": image, altitude, pitch, roll" : "");
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
        pose.fault = count_fault(layout, fields.size());
        return pose;
    }
    pose.sled.altitude_m = number(Altitude);
    if (columns.place(Pitch)) pose.sled.pitch_rad = number(Pitch) * radians_per_unit;
    if (columns.place(Roll)) pose.sled.roll_rad = number(Roll) * radians_per_unit;
    // Users of the place report what is missing.
    ImagePose unsaid;
    const auto of_place = [&](NavigationField field, double unit) {
        const auto column = columns.place(field);
        return column ? number_in(unsaid, columns.name(field), fields[*column]) * unit
                      : std::numeric_limits<double>::quiet_NaN();
    };
    pose.place = {.east_m = of_place(East, 1.0),
                  .north_m = of_place(North, 1.0),
                  .heading_rad = of_place(Heading, radians_per_unit),
                  .depth_m = of_place(Depth, 1.0)};
    return pose;
}

void add_time(ImagePose& pose, const NavigationColumns& columns, const Fields& fields) {
    if (!pose.fault.empty()) return;
    const std::string& text = fields[*columns.place(Time)];
    const auto time_s = unix_time_s(text);
    pose.time_s = time_s.value_or(0.0);
    if (time_s) return;
    pose.fault = fmt::format(
        "{}: found {}; allowed: seconds since 1970, or a time such as 2024-03-09 12:34:56.789",
        columns.name(Time),
        shown_word(text));
}

// A table's columns and separator, determined from its first line, which may be a header.
class LayoutReader {
  public:
    LayoutReader(TableText& table, HeaderRequest request)
        : table_(table), request_(std::move(request)) {}

    // Empty if the text ends without a table. Otherwise the table is at its first row of values.
    std::optional<Layout> read() {
        while (table_.find_row('\0')) {
            request_.line = table_.line();
            if (auto layout = of_header()) return layout;
            if (auto layout = of_comment()) return layout;
            if (auto layout = of_values()) return layout;
            if (!is_passed_over()) refuse_header(request_, table_.row(most_frequent()).fields);
            table_.pass_line();
        }
        return std::nullopt;
    }

  private:
    std::optional<Layout> of_header() {
        for (const char separator : kSeparators) {
            const auto columns = navigation_columns(request_, table_.row(separator).fields);
            if (!columns) continue;
            table_.take_row(separator);
            return Layout{.columns = *columns, .separator = separator, .has_header = true};
        }
        return std::nullopt;
    }

    // A header row in a comment, just before a line with as many fields.
    std::optional<Layout> of_comment() {
        TableText comment(request_.file, table_.last_comment());
        for (const char separator : kSeparators) {
            const Fields header = comment.row(separator).fields;
            if (header.size() != table_.row(separator).fields.size()) continue;
            if (const auto columns = navigation_columns(request_, header))
                return Layout{.columns = *columns, .separator = separator, .has_header = true};
        }
        return std::nullopt;
    }

    // From the values themselves.
    std::optional<Layout> of_values() {
        for (const char separator : kSeparators) {
            if (!is_habcam_img(table_.row(separator).fields)) continue;
            const auto names = comma_fields(kHabCamColumns);
            const Fields header(names.begin(), names.end());
            const auto columns = navigation_columns(request_, header);
            if (!columns) refuse_header(request_, header);
            return Layout{.columns = *columns, .separator = separator};
        }
        const Fields words = table_.row(kByBlanks).fields;
        const Fields cells = table_.row(';').fields;
        std::optional<Layout> layout;
        if (is_eic(words)) layout = eic_layout();
        if (is_dim2(cells)) layout = dim2_layout(cells.size());
        if (is_acfr_line(words)) layout = acfr_layout();
        if (layout && !request_.given.empty()) {
            fail_at_line(request_.file, request_.line, "found no header row; needed by --columns");
        }
        return layout;
    }

    // Rows of separators only, comments that begin with ;, the separator line of spreadsheets, and
    // the origin of ACFR's coordinates.
    [[nodiscard]] bool is_passed_over() const {
        const auto is_empty = [](const std::string& field) { return field.empty(); };
        return std::ranges::all_of(table_.row(most_frequent()).fields, is_empty) ||
               table_.begins_with(";") || table_.begins_with("sep=") ||
               table_.begins_with("ORIGIN_LATITUDE") || table_.begins_with("ORIGIN_LONGITUDE");
    }

    // Blanks separate words only if nothing else does.
    [[nodiscard]] char most_frequent() const {
        char best = kByBlanks;
        std::size_t most = 1;
        for (const char separator : {',', ';', '\t'}) {
            const std::size_t count = table_.row(separator).fields.size();
            if (count > most) best = separator;
            most = std::max(most, count);
        }
        return best;
    }

    TableText& table_;
    HeaderRequest request_;
};

bool is_pangaeas(std::string_view text) {
    return without_byte_order_mark(text).starts_with("/* DATA DESCRIPTION");
}

// A warning if a last number may lack digits: the line ends with the file.
std::string cut_warning(const std::string& name, const Layout& layout, const TextRow& row) {
    if (row.has_line_end || layout.is_acfrs || row.fields.size() != layout.columns.count) return "";
    const std::size_t last = row.fields.size() - 1;
    for (const NavigationField field : {Time, Altitude, Pitch, Roll, East, North, Heading, Depth}) {
        if (layout.columns.place(field) != last) continue;
        return fmt::format(
            "{}:{}: the file ends within this line, without a line break: if it was truncated, {} "
            "= {} may lack digits",
            name,
            row.line,
            shown_word(layout.columns.name(field)),
            shown_word(row.fields[last]));
    }
    return "";
}

void add_rows(NavigationTable& table,
              const Layout& layout,
              const TextRow& row,
              const Sled& rig_sled,
              double radians_per_unit) {
    if (layout.is_acfrs) {
        const auto [left, right] = acfr_poses(row.fields, row.line);
        table.poses.push_back(left);
        if (right.image != left.image) table.poses.push_back(right);
        return;
    }
    const NavigationColumns& columns = layout.columns;
    ImagePose pose{.sled = rig_sled, .line = row.line};
    if (const auto image = columns.place(Image); image && *image < row.fields.size())
        pose.image = row.fields[*image];
    pose = pose_in(layout, row.fields, std::move(pose), radians_per_unit);
    if (columns.is_track()) add_time(pose, columns, row.fields);
    table.poses.push_back(std::move(pose));
}

}  // namespace

NavigationTable parse_navigation_csv(const std::string& name,
                                     std::string_view text,
                                     const Sled& rig_sled,
                                     const ColumnNames& given,
                                     AngleUnit angles_in,
                                     bool has_places) {
    const double radians_per_unit = angles_in == AngleUnit::Degrees ? kRadiansPerDegree : 1.0;
    TableText lines(name, text);
    LayoutReader reader(lines,
                        {.file = name,
                         .given = given,
                         .angles_in = angles_in,
                         .is_pangaeas = is_pangaeas(text),
                         .has_places = has_places});
    const std::optional<Layout> layout = reader.read();
    NavigationTable table;
    while (layout && lines.find_row(layout->separator)) {
        const TextRow row = lines.take_row(layout->separator);
        // Spreadsheets end a table with rows of commas only.
        if (std::ranges::all_of(row.fields, &std::string::empty)) continue;
        if (table.poses.size() >= kMostNavigationRows) {
            fail_at_line(name, row.line, "found more than {} lines", kMostNavigationRows);
        }
        add_rows(table, *layout, row, rig_sled, radians_per_unit);
        table.cut_warning = cut_warning(name, *layout, row);
    }
    if (layout) table.columns = layout->columns;
    if (layout && layout->is_acfrs) table.are_cameras_own = true;
    const bool is_of_use = std::ranges::any_of(table.poses, [&](const ImagePose& pose) {
        return table.columns.is_track() || !pose.image.empty();
    });
    if (!is_of_use) {
        fail_at_line(name,
                     lines.line(),
                     "the file ends without a line of {}",
                     layout && table.columns.is_track() ? "a pose" : "an image");
    }
    return table;
}

}  // namespace aphotic
