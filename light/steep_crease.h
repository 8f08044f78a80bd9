// SPDX-License-Identifier: BSD-3-Clause
//
// The creases of a beam (rig/beam/beam_crease.h) at which its intensity bends so much that no
// crossing by a dispersed ray may be missed: kinks at which the slope of I changes by more than
// kSteepPerDegree of the largest I over a degree, and the ends of soft edges and blurs that are as
// steep.
#pragma once

#include "rig/beam/beam_crease.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace aphotic {

inline constexpr double kSteepPerDegree = 0.1;
[[nodiscard]] std::vector<Crease> steep_creases(const Beam& beam, const BeamFrame& frame);

// Whether a direction crosses it on the way from the second of these to the third, along the
// parabola through all three, of which the first is the middle. Directions are of any length but 0.
[[nodiscard]] bool crosses(const Crease& crease, const std::array<Eigen::Vector3d, 3>& towards);

}  // namespace aphotic
