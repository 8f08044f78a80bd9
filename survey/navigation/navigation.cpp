// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/navigation.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/printable.h"
#include "base/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

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

namespace {

struct Bounds {
    double least;
    double most;
};
constexpr Bounds kAltitude_m{kLeastAltitude_m, kMostAltitude_m};
constexpr Bounds kTilt_deg{-kMostTilt_deg, kMostTilt_deg};

// The file's name without its folder (with either kind of slash) and without an image extension.
std::string name_in(std::string_view image) {
    const std::size_t slash = image.find_last_of("/\\");
    if (slash != std::string_view::npos) image.remove_prefix(slash + 1);
    return without_extension(image).string();
}

[[noreturn]] void fail_at_pose(const std::string& source,
                               const ImagePose& pose,
                               const std::string& what) {
    if (pose.line > 0) fail_at_line(source, pose.line, what);
    throw InputError("{}: {}", source, what);
}

std::string fault_in(std::string_view what, double value, const Bounds& bounds) {
    if (value >= bounds.least && value <= bounds.most) return "";
    return fmt::format("{}: found {}; allowed: {} to {}",
                       what,
                       std::isnan(value) ? "no number" : fmt::format("{:.6g}", value),
                       bounds.least,
                       bounds.most);
}

}  // namespace

std::string fault_of(const Sled& sled) {
    for (const std::string& fault :
         {fault_in("altitude_m", sled.altitude_m, kAltitude_m),
          fault_in("pitch_deg", sled.pitch_rad / kRadiansPerDegree, kTilt_deg),
          fault_in("roll_deg", sled.roll_rad / kRadiansPerDegree, kTilt_deg)}) {
        if (!fault.empty()) return fault;
    }
    return "";
}

Navigation::Navigation(std::string source,
                       const std::vector<ImagePose>& poses,
                       GivenAngles given,
                       ImagesKnownBy known_by)
    : source_(std::move(source)), given_(given), known_(given), known_by_(known_by) {
    for (const ImagePose& pose : poses) {
        if (pose.image.empty()) {
            if (nameless_line_ == 0) nameless_line_ = pose.line;
            continue;
        }
        const std::string key = key_of(pose.image);
        const auto [first, is_new] = poses_.try_emplace(key, pose);
        if (is_new) continue;
        first->second.fault =
            fmt::format("duplicate image '{}'{}",
                        excerpt(key),
                        pose.line > 0 ? fmt::format(", also on line {}", pose.line) : "");
    }
}

std::string Navigation::key_of(const std::string& image) const {
    return known_by_ == ImagesKnownBy::Path ? image : name_in(image);
}

const ImagePose& Navigation::pose_of(const std::filesystem::path& image) const {
    const auto found = poses_.find(key_of(image.string()));
    if (found == poses_.end()) {
        throw InputError(
            "{} has no line for it{}",
            source_,
            nameless_line_ > 0 ? fmt::format("; line {} names no image", nameless_line_) : "");
    }
    const ImagePose& pose = found->second;
    const Sled& sled = pose.sled;
    if (!pose.fault.empty()) fail_at_pose(source_, pose, pose.fault);
    const std::string fault = fault_of(sled);
    if (!fault.empty()) fail_at_pose(source_, pose, fault);
    if (sled.altitude_m < least_m_ || sled.altitude_m > most_m_) {
        throw InputError("altitude_m: found {}; allowed by --altitude: {} to {}",
                         sled.altitude_m,
                         least_m_,
                         most_m_);
    }
    return pose;
}

std::vector<std::string> Navigation::images() const {
    std::vector<const ImagePose*> poses;
    for (const auto& [key, pose] : poses_) poses.push_back(&pose);
    std::ranges::sort(poses, [](const ImagePose* a, const ImagePose* b) {
        return std::tie(a->line, a->image) < std::tie(b->line, b->image);
    });
    std::vector<std::string> images;
    for (const ImagePose* pose : poses) images.push_back(pose->image);
    return images;
}

bool Navigation::tells_depth() const {
    return std::ranges::any_of(
        poses_, [](const auto& pose) { return std::isfinite(pose.second.place.depth_m); });
}

void Navigation::mount(const Mounting& mounting) {
    for (auto& [key, pose] : poses_) {
        // Checked for the vehicle: an impossible pose is reported in its own numbers.
        if (!pose.fault.empty() || !fault_of(pose.sled).empty()) continue;
        try {
            pose.place = camera_place(pose.place, pose.sled, mounting);
            pose.sled = camera_pose(pose.sled, mounting);
        } catch (const InputError& error) {
            pose.fault = error.what();
        }
    }
}

void Navigation::limit_altitude(double least_m, double most_m) {
    least_m_ = least_m;
    most_m_ = most_m;
}

}  // namespace aphotic
