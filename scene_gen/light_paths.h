// SPDX-License-Identifier: BSD-3-Clause
//
// The family of light (spectral/light_family.h) that a rig's camera can see: every lamp's
// spectrum on every material, and bare where the floor has a highlight, over the paths from the
// shortest to the longest.
//
// A path l = d + r runs from a lamp to the floor that the image sees and on to the camera, in
// water. Over the image it is quasi-convex: so the longest is at a corner, and the shortest is
// found by nested searches along rows and columns. Emitters add and take half their diagonal.
// Behind a port all of the rim is looked at, at both ends of the range and in its middle; kPathRoom
// is for what lies between.
//
// Objects only widen this: a path by way of an object is no shorter than from the lamp straight to
// its bounds and on to the camera, and no longer than by their farthest corners.
//
// With the horizon in view paths have no end, or nearly so when it is close. The longest that
// counts is that from which no light over kDarkShare of the brightest can come.
//
// Behind a port, each wavelength shows its own point of the floor: the family's tilt is the largest
// change of light on the way from the middle wavelength's point to it, over the image. Diffuse
// light and highlight, and lamps of different spectra, change by themselves, each counted by its
// share. On objects, which turn away from the light and end, no such change is the largest: there
// it counts up to kObjectTilt, growing with the shift of the image, and pixels where it is more are
// among the edges, for which nothing is promised.
#pragma once

#include "scene_gen/rig.h"
#include "spectral/light_family.h"

namespace aphotic {

inline constexpr double kPathRoom = 1.001;
inline constexpr double kDarkShare = 1e-11;
// Logarithm of a change of light.
inline constexpr double kObjectTilt = 0.05;

struct PathRange {
    double shortest_m = 0.0;
    double longest_m = 0.0;
    bool has_horizon = false;  // longest_m is where the light ends, not the floor
};

// Both zero when the image sees no floor and no object.
[[nodiscard]] PathRange path_range(const Rig& rig);

// Lamps with the same spectrum are one, and so are materials.
[[nodiscard]] LightFamily light_family(const Rig& rig);

// The materials of the light that the rig shows and is planned for, in this order: the floor's, the
// further ones, the objects'.
[[nodiscard]] std::vector<Spectrum> materials_of(const Rig& rig);

// The same with one set of sources per strobe, in their order: for each the materials and, where
// anything has a highlight, the bare lamp.
[[nodiscard]] LightFamily light_family_by_strobe(const Rig& rig);

}  // namespace aphotic
