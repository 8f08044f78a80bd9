// SPDX-License-Identifier: BSD-3-Clause
#include "survey/habcam_tags.h"

#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/printable.h"
#include "survey/navigation_cell.h"

#include <fmt/format.h>

#include <limits>
#include <optional>

namespace aphotic {
namespace {

std::optional<std::string_view> tag_in(std::string_view description, std::string_view key) {
    for (const std::string_view tag : comma_fields(description)) {
        const std::size_t equals = tag.find('=');
        if (equals == std::string_view::npos || trimmed(tag.substr(0, equals)) != key) continue;
        return trimmed(tag.substr(equals + 1));
    }
    return std::nullopt;
}

double tagged_number(ImagePose& pose, std::string_view description, const std::string& key) {
    constexpr std::size_t kMostShown = 80;
    if (const auto value = tag_in(description, key)) return number_in(pose, key, *value);
    if (pose.fault.empty()) {
        pose.fault = fmt::format("found the ImageDescription '{}{}'; needed in it: {}=NUMBER",
                                 printable(description.substr(0, kMostShown)),
                                 description.size() > kMostShown ? "..." : "",
                                 key);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

ColumnNames tag_names(const ColumnNames& given) {
    ColumnNames names{{"altitude_m", "alt0"}, {"pitch_deg", "pitch"}, {"roll_deg", "roll"}};
    for (const auto& [ours, theirs] : given) {
        const auto name = names.find(ours);
        if (name == names.end()) {
            throw InputError(
                "--columns: found '{}'; allowed with --nav tags: altitude_m, pitch_deg, roll_deg",
                ours);
        }
        name->second = theirs;
    }
    return names;
}

void read_tags(ImagePose& pose,
               std::string_view description,
               const ColumnNames& names,
               AngleUnit angles_in) {
    const double radians_per_unit = angles_in == AngleUnit::Degrees ? kRadiansPerDegree : 1.0;
    const auto number = [&](const char* ours) {
        return tagged_number(pose, description, names.at(ours));
    };
    pose.sled = {.altitude_m = number("altitude_m"),
                 .pitch_rad = number("pitch_deg") * radians_per_unit,
                 .roll_rad = number("roll_deg") * radians_per_unit};
}

}  // namespace aphotic
