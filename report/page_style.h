// SPDX-License-Identifier: BSD-3-Clause
//
// The style of pages and plots: svg.css and page.css, embedded in the library. Plots are part of
// pages, or files of their own, which are also drawn by programs other than browsers: svg.css uses
// only features that every SVG reader supports. Pages are for screens of any width, and A4 paper.
#pragma once

#include <span>
#include <string_view>

namespace aphotic {

struct StyleSheet {
    std::string_view name;
    std::string_view css;
};

// The style of plots, then of pages.
[[nodiscard]] std::span<const StyleSheet> style_sheets();

}  // namespace aphotic
