// SPDX-License-Identifier: BSD-3-Clause
//
// Text and numbers as a page shows them, and the page around them.
//
//   escaped("a < \"b\"")   a &lt; &quot;b&quot;
//   scientific(4.6e-4)     4.60 × 10⁻⁴
//   plain(-26.0)           −26
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aphotic {

// Safe between tags and in quoted attributes, of HTML and of XML. Line breaks and tabs become
// blanks; other control characters, which XML does not allow, become U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

// The same for names that users chose, whose direction of writing must not spill over.
[[nodiscard]] std::string user_text(std::string_view text);

// Three significant digits; 0, ∞ and "not a number" in words. 0.01 up to 1000 without a power.
[[nodiscard]] std::string scientific(double value);

// That of a number in fmt's {:e}: 3 of "1.5e+03".
[[nodiscard]] int exponent_of(std::string_view text);

// factor × 10^exponent; a factor of 1 is left out.
[[nodiscard]] std::string power_label(double factor, int exponent);

// At most six significant digits, trailing zeros dropped.
[[nodiscard]] std::string plain(double value);

// "1 frame", "2 frames", as counted() of base/words.h, with thousands set apart.
[[nodiscard]] std::string grouped_count(std::size_t count, std::string_view noun);

// 1 392 640, with narrow blanks that do not break.
[[nodiscard]] std::string grouped(std::size_t count);

// The parts of a page. Contents, headings and cells are markup.
[[nodiscard]] std::string html_paragraph(std::string_view content);
[[nodiscard]] std::string html_section(std::string_view id,
                                       std::string_view heading,
                                       std::string_view content);
// What the page is of, its heading, and what comes first.
[[nodiscard]] std::string html_header(std::string_view kind,
                                      std::string_view heading,
                                      std::string_view content);
// The answer in a word or a sentence, green or red, and more on it.
[[nodiscard]] std::string html_verdict(bool holds, std::string_view word, std::string_view content);
// An entry of a legend; the drawing is an <svg>. A stroke is drawn in that style (svg.h).
[[nodiscard]] std::string html_key(std::string_view drawing, std::string_view words);
[[nodiscard]] std::string html_stroke_key(std::string_view style, std::string_view words);
[[nodiscard]] std::string html_legend(std::string_view keys);
// Lines as they are.
[[nodiscard]] std::string html_source(std::string_view text);

using HtmlItem = std::pair<std::string, std::string>;  // a term and what it means
[[nodiscard]] std::string html_list(std::string_view id, std::span<const HtmlItem> items);

struct HtmlRow {
    std::string_view style;  // its CSS class
    std::vector<std::string> cells;
};
// columns: plain headings with semicolons between them, such as "rig;error;". The first column
// names the rows; one without a heading is that of marks. In a narrow window it scrolls sideways.
[[nodiscard]] std::string html_table(std::string_view id,
                                     std::string_view columns,
                                     std::span<const HtmlRow> rows);

// A whole file that a browser lets neither run nor fetch anything, whatever a title may hold. The
// title is plain text; content is what the page shows.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view content);

}  // namespace aphotic
