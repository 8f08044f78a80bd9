// SPDX-License-Identifier: BSD-3-Clause
//
// Degrees, for people, and radians, in which everything here computes.
#pragma once

#include <numbers>

namespace aphotic {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace aphotic
