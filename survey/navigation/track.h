// SPDX-License-Identifier: BSD-3-Clause
//
// Poses over time, between which images' poses are interpolated linearly:
//
//   pose(t) = pose_i + (pose_i+1 - pose_i) (t - t_i) / (t_i+1 - t_i),     t_i <= t <= t_i+1
//
// and their places likewise, headings the shorter way round. At a point's own time it is that
// point's pose. A point's angles are within 89.9 degrees of level, so that this is the shorter way
// round. If the altitude has an acceleration a, the error is at most a (t_i+1 - t_i)^2 / 8: for a
// sled that swell heaves by half a metre every ten seconds, 0.2 m/s^2, that is 0.1 m over
// kLongestGap_s, the width of an altitude bin.
#pragma once

#include "survey/navigation/navigation.h"

#include <vector>

namespace aphotic {

inline constexpr double kLongestGap_s = 2.0;

class Track {
  public:
    // In any order; of several at the same time, the first is used.
    Track(std::vector<ImagePose> points, double longest_gap_s);

    // An InputError if the time is before the first point, after the last, or between two that are
    // more than longest_gap_s apart.
    [[nodiscard]] ImagePose at(double time_s) const;

  private:
    std::vector<ImagePose> points_;  // by time
    double longest_gap_s_;
};

}  // namespace aphotic
