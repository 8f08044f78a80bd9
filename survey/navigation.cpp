// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kBlanks = " \t\r";

// What a rig file allows, too.
struct Bounds {
    double least;
    double most;
};
constexpr Bounds kAltitude_m{0.001, 10000.0};
constexpr Bounds kTilt_deg{-89.9, 89.9};

constexpr std::string_view kImage = "image";
constexpr std::string_view kAltitude = "altitude_m";
constexpr std::string_view kPitch = "pitch_deg";
constexpr std::string_view kRoll = "roll_deg";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view unquoted(std::string_view field) {
    const bool is_quoted = field.size() > 1 && field.front() == '"' && field.back() == '"';
    return is_quoted ? field.substr(1, field.size() - 2) : field;
}

std::vector<std::string_view> comma_fields(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t start = 0; start <= line.size();) {
        const std::size_t end = std::min(line.find(',', start), line.size());
        fields.push_back(trimmed(unquoted(trimmed(line.substr(start, end - start)))));
        start = end + 1;
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
            fail_at_line(name, line, fmt::format("the column '{}' stands twice", column));
        }
    }
    for (const std::string_view needed : {kImage, kAltitude}) {
        if (column_named(columns, needed)) continue;
        const std::vector<std::string> known(columns.begin(), columns.end());
        const std::string near = nearest_name(needed, known);
        fail_at_line(name,
                     line,
                     fmt::format("found the columns {}; needed: '{}'{}; allowed besides: {}, {}",
                                 fmt::join(columns, ","),
                                 needed,
                                 near.empty() ? "" : fmt::format(" (is it '{}'?)", near),
                                 kPitch,
                                 kRoll));
    }
    // Of an optional one under another name, the rig's would be taken and nobody be told.
    for (const auto& [wanted, word] : {std::pair{kPitch, "pitch"}, std::pair{kRoll, "roll"}}) {
        if (column_named(columns, wanted)) continue;
        for (const std::string_view column : columns) {
            if (!column.starts_with(word)) continue;
            fail_at_line(
                name, line, fmt::format("found the column '{}'; allowed: '{}'", column, wanted));
        }
    }
    return {.has_commas = true,
            .fields = columns.size(),
            .image = *column_named(columns, kImage),
            .altitude = *column_named(columns, kAltitude),
            .pitch = column_named(columns, kPitch),
            .roll = column_named(columns, kRoll)};
}

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

// What loggers, databases and spreadsheets write when they know no number, besides NaN itself.
bool is_unknown(std::string_view field) {
    static constexpr std::array<std::string_view, 8> kUnknown{
        "", "-", "na", "n/a", "#n/a", "null", "none", "1.#qnan"};
    return std::ranges::find(kUnknown, lower(std::string(field))) != kUnknown.end();
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
    ImagePose pose{.image = {}, .line = line, .sled = rig_sled, .fault = {}};
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

// The file's name without its folder, of either kind of slash, and without an image's extension.
std::string key_of(std::string_view image) {
    const std::size_t slash = image.find_last_of("/\\");
    if (slash != std::string_view::npos) image.remove_prefix(slash + 1);
    const fs::path file(image);
    return is_image_name(file) ? file.stem().string() : file.string();
}

void require(const std::string& name,
             const ImagePose& pose,
             std::string_view column,
             double value,
             const Bounds& bounds) {
    if (value >= bounds.least && value <= bounds.most) return;
    fail_at_line(name,
                 pose.line,
                 fmt::format("{}: found {}; allowed: {} to {}",
                             column,
                             std::isnan(value) ? "no number" : fmt::format("{:.6g}", value),
                             bounds.least,
                             bounds.most));
}

}  // namespace

const ImagePose& Navigation::pose_of(const fs::path& image) const {
    const auto found = poses_.find(key_of(image.string()));
    if (found == poses_.end()) {
        throw InputError(fmt::format(
            "{} has no line for it{}",
            name_,
            nameless_line_ > 0 ? fmt::format("; line {} has no image's name", nameless_line_)
                               : ""));
    }
    const ImagePose& pose = found->second;
    if (!pose.fault.empty()) fail_at_line(name_, pose.line, pose.fault);
    require(name_, pose, kAltitude, pose.sled.altitude_m, kAltitude_m);
    require(name_, pose, kPitch, pose.sled.pitch_rad / kRadiansPerDegree, kTilt_deg);
    require(name_, pose, kRoll, pose.sled.roll_rad / kRadiansPerDegree, kTilt_deg);
    return pose;
}

void Navigation::add(ImagePose pose) {
    if (pose.image.empty()) {
        if (nameless_line_ == 0) nameless_line_ = pose.line;
        return;
    }
    const std::string key = key_of(pose.image);
    const auto [first, is_new] = poses_.try_emplace(key, pose);
    if (is_new) return;
    first->second.fault =
        fmt::format("the image '{}' stands twice, also on line {}", key, pose.line);
}

Navigation parse_navigation(const std::string& name, std::string_view text, const Sled& rig_sled) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    Navigation navigation;
    navigation.name_ = name;
    std::optional<ColumnLayout> layout;
    std::size_t line = 0;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        const std::string_view content = trimmed(text.substr(start, end - start));
        ++line;
        start = end + 1;
        // Spreadsheets end a table with rows of commas alone.
        const bool is_empty = content.find_first_not_of(',') == std::string_view::npos;
        if (is_empty || content.front() == '#') continue;
        if (!layout && content.find(',') != std::string_view::npos) {
            layout = layout_of(name, line, comma_fields(content));
            navigation.has_pitch_ = layout->pitch.has_value();
            navigation.has_roll_ = layout->roll.has_value();
            continue;
        }
        if (!layout) layout = ColumnLayout{};
        navigation.add(pose_in(line,
                               *layout,
                               layout->has_commas ? comma_fields(content) : blank_fields(content),
                               rig_sled));
    }
    if (navigation.poses_.empty())
        fail_at_line(name, line + 1, "the file ends without a line of an image");
    return navigation;
}

Navigation read_navigation(const fs::path& file, const Sled& rig_sled) {
    return parse_navigation(file.string(), read_text_file(file), rig_sled);
}

bool is_image_name(const fs::path& file) {
    static constexpr std::array<std::string_view, 6> kExtensions{
        ".tif", ".tiff", ".png", ".exr", ".jpg", ".jpeg"};
    return std::ranges::find(kExtensions, lower(file.extension().string())) != kExtensions.end();
}

}  // namespace aphotic
