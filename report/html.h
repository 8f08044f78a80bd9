// SPDX-License-Identifier: BSD-3-Clause
//
// Text and numbers as a page shows them, and the page around them.
//
//   escaped("a < \"b\"")   a &lt; &quot;b&quot;
//   scientific(4.6e-4)     4.60 × 10⁻⁴
//   plain(-26.0)           −26
#pragma once

#include <string>
#include <string_view>

namespace aphotic {

// Safe between tags and in quoted attributes, of HTML and of XML. Line breaks and tabs become
// blanks; other control characters, which XML does not allow, become U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

// The same for names that users chose, whose direction of writing must not spill over.
[[nodiscard]] std::string user_text(std::string_view text);

// Three significant digits; 0, ∞ and "not a number" in words. 0.01 up to 1000 without a power.
[[nodiscard]] std::string scientific(double value);

// factor × 10^exponent; a factor of 1 is left out.
[[nodiscard]] std::string power_label(double factor, int exponent);

// At most six significant digits, trailing zeros dropped.
[[nodiscard]] std::string plain(double value);

// "1" and the noun, or the number and the noun with an s; thousands set apart.
[[nodiscard]] std::string counted(std::size_t count, std::string_view noun);

// 1 392 640, with narrow blanks that do not break.
[[nodiscard]] std::string grouped(std::size_t count);

// The content is markup.
[[nodiscard]] std::string html_paragraph(std::string_view content);
[[nodiscard]] std::string html_section(std::string_view id,
                                       std::string_view heading,
                                       std::string_view content);

// A whole file that a browser lets neither run nor fetch anything, whatever a title may hold. The
// title is plain text; content is what the page shows.
[[nodiscard]] std::string html_page(std::string_view title,
                                    std::string_view style,
                                    std::string_view content);

}  // namespace aphotic
