// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation_acfr.h"

#include "survey/navigation_cell.h"

#include <fmt/format.h>

#include <cmath>

namespace aphotic {
namespace {

enum AcfrWord : std::size_t { kPhi = 7, kTheta = 8, kLeft = 10, kRight = 11, kAltitude = 12 };
constexpr std::size_t kAcfrWords = 15;

bool is_numeric_word(std::string_view word) {
    ImagePose none;
    static_cast<void>(number_in(none, "", word));
    return none.fault.empty();
}

}  // namespace

bool is_acfr_line(const std::vector<std::string>& words) {
    if (words.size() != kAcfrWords) return false;
    for (std::size_t i = 0; i < kAcfrWords; ++i) {
        const bool is_name = i == kLeft || i == kRight;
        if (is_name == is_numeric_word(words[i])) return false;
    }
    return true;
}

std::array<ImagePose, 2> acfr_poses(const std::vector<std::string>& words, std::size_t line) {
    ImagePose pose{.line = line};
    if (words.size() != kAcfrWords) {
        pose.fault = fmt::format("found {} fields; allowed: {}", words.size(), kAcfrWords);
    } else {
        const double phi = number_in(pose, "X-axis Euler angle", words[kPhi]);
        const double theta = number_in(pose, "Y-axis Euler angle", words[kTheta]);
        pose.sled = {.altitude_m = number_in(pose, "altitude", words[kAltitude]),
                     .pitch_rad = std::asin(std::cos(theta) * std::sin(phi)),
                     .roll_rad = std::atan2(-std::sin(theta), std::cos(theta) * std::cos(phi))};
    }
    std::array<ImagePose, 2> poses{pose, pose};
    if (words.size() > kLeft) poses[0].image = words[kLeft];
    if (words.size() > kRight) poses[1].image = words[kRight];
    return poses;
}

}  // namespace aphotic
