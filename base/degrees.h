// SPDX-License-Identifier: BSD-3-Clause
//
// Conversion between degrees, for people, and radians, for all computations.
#pragma once

#include <numbers>

namespace aphotic {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace aphotic
