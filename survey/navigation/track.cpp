// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/track.h"

#include "base/error.h"
#include "survey/navigation/time_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aphotic {

Track::Track(std::vector<TrackPoint> points, double longest_gap_s)
    : points_(std::move(points)), longest_gap_s_(longest_gap_s) {
    std::ranges::stable_sort(points_, {}, &TrackPoint::time_s);
    const auto is_again = [](const TrackPoint& a, const TrackPoint& b) {
        return a.time_s == b.time_s;
    };
    points_.erase(std::unique(points_.begin(), points_.end(), is_again), points_.end());
}

Sled Track::at(double time_s) const {
    if (points_.empty()) throw InputError("has no usable line");
    const auto after = std::ranges::lower_bound(points_, time_s, {}, &TrackPoint::time_s);
    if (after != points_.end() && after->time_s == time_s) return after->sled;
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
    const auto between = [&](double Sled::*part) {
        return std::lerp(before->sled.*part, after->sled.*part, share);
    };
    return {between(&Sled::altitude_m), between(&Sled::pitch_rad), between(&Sled::roll_rad)};
}

}  // namespace aphotic
