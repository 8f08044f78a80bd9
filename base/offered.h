// SPDX-License-Identifier: BSD-3-Clause
//
// A number that a message suggests, "allowed: 0.0465 or more", in few digits that are valid when
// typed: a lower limit rounded up, an upper one down, and the printed number is the tested one.
// 0.12345 in three digits is at least 0.124 and at most 0.123; 0.1 stays 0.1.
#pragma once

namespace aphotic {

inline constexpr int kOfferedDigits = 3;

// The nearest number of this many significant digits that is not less, or not more, as read back
// from its digits. Numbers that are not finite are returned unchanged.
[[nodiscard]] double at_least(double value, int digits = kOfferedDigits);
[[nodiscard]] double at_most(double value, int digits = kOfferedDigits);

}  // namespace aphotic
