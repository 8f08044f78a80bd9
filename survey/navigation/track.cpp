// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/track.h"

#include "base/error.h"
#include "survey/navigation/time_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace aphotic {

Track::Track(std::vector<ImagePose> points, double longest_gap_s)
    : points_(std::move(points)), longest_gap_s_(longest_gap_s) {
    std::ranges::stable_sort(points_, {}, &ImagePose::time_s);
    const auto is_again = [](const ImagePose& a, const ImagePose& b) {
        return a.time_s == b.time_s;
    };
    points_.erase(std::unique(points_.begin(), points_.end(), is_again), points_.end());
}

ImagePose Track::at(double time_s) const {
    constexpr double kRound_rad = 2.0 * std::numbers::pi;
    if (points_.empty()) throw InputError("has no line that could be used");
    const auto after = std::ranges::lower_bound(points_, time_s, {}, &ImagePose::time_s);
    if (after != points_.end() && after->time_s == time_s) return *after;
    if (after == points_.begin()) {
        throw InputError("the image's time, {}, is {:.6g} s before the first, of line {}",
                         utc_text(time_s),
                         after->time_s - time_s,
                         after->line);
    }
    const auto before = after - 1;
    if (after == points_.end()) {
        throw InputError("the image's time, {}, is {:.6g} s after the last, of line {}",
                         utc_text(time_s),
                         time_s - before->time_s,
                         before->line);
    }
    const double gap_s = after->time_s - before->time_s;
    if (gap_s > longest_gap_s_) {
        throw InputError(
            "the image's time, {}, is in a gap of {:.6g} s, between lines {} and {}; allowed by "
            "--longest-gap-s: {}",
            utc_text(time_s),
            gap_s,
            before->line,
            after->line,
            longest_gap_s_);
    }
    const double share = (time_s - before->time_s) / gap_s;
    const auto between = [&](auto whole, auto part) {
        return std::lerp((*before).*whole.*part, (*after).*whole.*part, share);
    };
    const double turn_rad =
        std::remainder(after->place.heading_rad - before->place.heading_rad, kRound_rad);
    return {.time_s = time_s,
            .sled = {.altitude_m = between(&ImagePose::sled, &Sled::altitude_m),
                     .pitch_rad = between(&ImagePose::sled, &Sled::pitch_rad),
                     .roll_rad = between(&ImagePose::sled, &Sled::roll_rad)},
            .place = {.east_m = between(&ImagePose::place, &Place::east_m),
                      .north_m = between(&ImagePose::place, &Place::north_m),
                      .heading_rad = before->place.heading_rad + share * turn_rad,
                      .depth_m = between(&ImagePose::place, &Place::depth_m)}};
}

}  // namespace aphotic
