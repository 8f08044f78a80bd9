// SPDX-License-Identifier: BSD-3-Clause
//
// The path lengths of the light that reaches a rig's camera.
//
//   l = d + r
//
//   d   from a lamp to the floor that the image sees, in water  [m]
//   r   from there to the camera, in water                      [m]
//
// Over the image l is quasi-convex: the longest path is at a corner, and the shortest is found by
// nested searches along rows and columns. Emitters add and subtract half their diagonal. Behind a
// port the whole rim is searched, at both ends of the range and in its middle; kPathRoom allows for
// what lies between.
//
// Objects only widen this: a path via an object is no shorter than from the lamp straight to its
// bounds and on to the camera, and no longer than via their farthest corners.
//
// With the horizon in view, paths are unbounded, or nearly so if it is close to the view. The
// longest relevant path is that beyond which no light exceeds kDarkShare of the brightest.
#pragma once

#include "rig/rig.h"

#include <vector>

namespace aphotic {

inline constexpr double kPathRoom = 1.001;
inline constexpr double kDarkShare = 1e-11;

struct PathRange {
    double shortest_m = 0.0;
    double longest_m = 0.0;
    bool has_horizon = false;  // longest_m is the end of the light, not of the floor
};

// Both zero if the image sees no floor and no object.
[[nodiscard]] PathRange path_range(const Rig& rig);

// Poses that bracket all of these: the lowest and the highest, level and as tilted as any.
[[nodiscard]] std::vector<Sled> corners_of(const std::vector<Sled>& sleds);

}  // namespace aphotic
