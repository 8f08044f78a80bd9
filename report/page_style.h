// SPDX-License-Identifier: BSD-3-Clause
//
// How pages and plots look: svg.css and page.css, which travel inside the library. Plots stand in
// pages and as files by themselves, which not only browsers draw: svg.css keeps to what every
// reader of SVG knows. Pages: on a screen of any width, and on A4 paper.
#pragma once

#include <span>
#include <string_view>

namespace aphotic {

struct StyleSheet {
    std::string_view name;
    std::string_view css;
};

// Of plots, then of pages.
[[nodiscard]] std::span<const StyleSheet> style_sheets();

}  // namespace aphotic
