// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation_notes.h"

#include "base/degrees.h"
#include "base/words.h"
#include "survey/vehicle_pose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <array>

namespace aphotic {

using Json = nlohmann::ordered_json;

namespace {

std::array<double, 3> numbers_of(const Eigen::Vector3d& vector) {
    return {vector.x(), vector.y(), vector.z()};
}

std::string_view word_of(AltitudeIs is) {
    return kAltitudeWords.at(static_cast<std::size_t>(is));
}

std::string altitude_words(const Mounting& mounting) {
    constexpr std::array<std::string_view, 3> kMeanings{
        "along the axis", "the vertical height", "the distance to the nearest floor"};
    std::string words(kMeanings.at(static_cast<std::size_t>(mounting.altitude_is)));
    if (mounting.altitude_offset_m != 0.0)
        words += fmt::format(", {:+g} m", mounting.altitude_offset_m);
    return words;
}

std::string image_time_words(const TimesOfImages& times) {
    std::string words =
        times.mask.empty() ? "EXIF's, else HabCam's names'" : "names' by " + times.mask;
    if (times.clock_offset_s != 0.0) words += fmt::format(", {:+g} s", times.clock_offset_s);
    words += fmt::format(", gaps up to {:g} s", times.longest_gap_s);
    if (times.lines_left_out > 0)
        words += fmt::format(", {} left out", counted(times.lines_left_out, "line"));
    return words;
}

}  // namespace

Json to_json(const NavigationNotes& notes) {
    const Mounting& mounting = notes.mounting;
    Json json{{"format", notes.format},
              {"columns", Json::object()},
              {"angles_in", notes.angles_in == AngleUnit::Degrees ? "deg" : "rad"}};
    for (const auto& [ours, theirs] : notes.columns) json["columns"][ours] = theirs;
    if (notes.times) {
        json["image_time"] = notes.times->mask;
        json["clock_offset_s"] = notes.times->clock_offset_s;
        json["longest_gap_s"] = notes.times->longest_gap_s;
    }
    json["altitude_is"] = word_of(mounting.altitude_is);
    json["altitude_offset_m"] = mounting.altitude_offset_m;
    if (is_mounted_apart(mounting)) {
        json["position_m"] = numbers_of(mounting.position_m);
        json["orientation_deg"] = numbers_of(mounting.roll_pitch_yaw_rad * kDegreesPerRadian);
    }
    return json;
}

std::string words_of(const NavigationNotes& notes) {
    std::vector<std::string> columns;
    for (const auto& [ours, theirs] : notes.columns) {
        columns.push_back(ours == theirs ? ours : fmt::format("{} '{}'", ours, theirs));
    }
    std::string words = fmt::format("{}: {}", notes.format, fmt::join(columns, ", "));
    words += notes.angles_in == AngleUnit::Degrees ? "; metres, degrees" : "; metres, radians";
    words += "; altitude: " + altitude_words(notes.mounting);
    if (notes.times) words += "; images' times: " + image_time_words(*notes.times);
    if (is_mounted_apart(notes.mounting)) {
        words += fmt::format(
            "; camera at [{:g}] m, turned by [{:g}] degrees",
            fmt::join(numbers_of(notes.mounting.position_m), ", "),
            fmt::join(numbers_of(notes.mounting.roll_pitch_yaw_rad * kDegreesPerRadian), ", "));
    }
    return words;
}

}  // namespace aphotic
