// SPDX-License-Identifier: BSD-3-Clause
//
// A number that a message offers, "allowed: 0.0465 and more", in few digits that hold when they are
// typed: a least number rounded up, a largest one down, and the number that is tried is the one
// that is printed. 0.12345 in three digits is at least 0.124 and at most 0.123; 0.1 stays 0.1.
#pragma once

#include <string>

namespace aphotic {

inline constexpr int kOfferedDigits = 3;

// The nearest number of so many significant digits that is not less, or not more; as it is read
// back from them. What is not finite stays.
[[nodiscard]] double at_least(double value, int digits = kOfferedDigits);
[[nodiscard]] double at_most(double value, int digits = kOfferedDigits);

// Digits that std::format's {} has for such a number: the fewest that give it back.
[[nodiscard]] std::string at_least_text(double value, int digits = kOfferedDigits);
[[nodiscard]] std::string at_most_text(double value, int digits = kOfferedDigits);

}  // namespace aphotic
