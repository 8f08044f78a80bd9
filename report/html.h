// SPDX-License-Identifier: BSD-3-Clause
//
// Text and numbers in the form used by pages and plots.
//
//   escaped("a < \"b\"")   a &lt; &quot;b&quot;
//   scientific(4.6e-4)     4.60 × 10⁻⁴
//   plain(-26.0)           −26
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace aphotic {

// Escaped for use between tags and in quoted attributes, in HTML and in XML. Line breaks and tabs
// become blanks; other control characters, which XML does not allow, become U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

// Three significant digits; 0, ∞ and "not a number" in words. No power from 0.01 up to 1000.
[[nodiscard]] std::string scientific(double value);

// The exponent of a number in fmt's {:e}: 3 for "1.5e+03".
[[nodiscard]] int exponent_of(std::string_view text);

// factor × 10^exponent; a factor of 1 is omitted.
[[nodiscard]] std::string power_label(double factor, int exponent);

// At most six significant digits, without trailing zeros.
[[nodiscard]] std::string plain(double value);

// "1 frame", "2 frames", like counted() of base/words.h, with thousands separated.
[[nodiscard]] std::string grouped_count(std::size_t count, std::string_view noun);

// 1 392 640, with narrow non-breaking spaces.
[[nodiscard]] std::string grouped(std::size_t count);

}  // namespace aphotic
