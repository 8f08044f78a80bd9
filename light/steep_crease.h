// SPDX-License-Identifier: BSD-3-Clause
//
// The creases of a beam (rig/beam/beam_crease.h) so steep that every crossing by a dispersed ray
// must be found: kinks at which the slope of I changes by more than kSteepPerDegree of the largest
// I over a degree, and the ends of equally steep soft edges and blurs. And the width of the
// narrowest light in a beam, which the spacing of samples must not exceed:
//
//   a cone               its width at half of its light, for a sharp one twice its half angle; for
//                        a lobe cos^n at most 2 / sqrt(n)
//   a table              two steps of its angles where they are smallest, if one of its lines is
//                        steep: a peak between two neighbours
//   an image by a lens   the angle of its shorter side
//
// A table without steep lines has no narrow light, and its width is pi. The same holds for a
// uniform lamp, a cone of 90 degrees with n = 0.
#pragma once

#include "rig/beam/beam_crease.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace aphotic {

inline constexpr double kSteepPerDegree = 0.1;
[[nodiscard]] std::vector<Crease> steep_creases(const Beam& beam, const BeamFrame& frame);

// Whether a direction crosses it between the second and the third of these, along the parabola
// through all three, of which the first is the middle. Directions are of any length but 0.
[[nodiscard]] bool crosses(const Crease& crease, const std::array<Eigen::Vector3d, 3>& towards);

[[nodiscard]] double narrowest_rad(const Beam& beam);

}  // namespace aphotic
