// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of a line drawing in SVG: panels with axes, curves and dots in them. Each function gives
// the text of some elements; svg_drawing() puts them into one <svg>.
//
//   x_px = left + width  (x - x.first) / (x.last - x.first)
//   y_px = top  + height (y.last - y) / (y.last - y.first)       log: of the logarithms
//
// Points that are not finite, or have no logarithm where one is needed, break a curve.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct SvgTick {
    double value = 0.0;
    std::string label;  // empty: a fine grid line
};

struct SvgAxis {
    double first = 0.0;
    double last = 1.0;
    bool log = false;
    std::vector<SvgTick> ticks;

    // 0 at first, 1 at last; NaN where there is no logarithm.
    [[nodiscard]] double fraction(double value) const;
};

// Ticks at multiples of 1, 2 or 5 times a power of ten, about `wanted` of them. unit_log10: the
// labels leave out this power of ten, which the axis's title then carries.
[[nodiscard]] SvgAxis linear_axis(double first, double last, int wanted, int unit_log10 = 0);

// From 1, 2 or 5 times a power of ten below `least` to one above `most`; both positive.
[[nodiscard]] SvgAxis log_axis(double least, double most);

// The least of 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is not under the value.
[[nodiscard]] double round_up(double value);

struct SvgPanel {
    double left = 0.0;
    double top = 0.0;
    double width = 0.0;
    double height = 0.0;
    SvgAxis x;
    SvgAxis y;

    [[nodiscard]] double x_px(double value) const { return left + width * x.fraction(value); }
    [[nodiscard]] double y_px(double value) const {
        return top + height * (1.0 - y.fraction(value));
    }
    [[nodiscard]] double right() const { return left + width; }
    [[nodiscard]] double bottom() const { return top + height; }
};

// The grid lines and the frame; then the labels of the ticks below and to the left.
[[nodiscard]] std::string svg_grid(const SvgPanel& panel);
[[nodiscard]] std::string svg_x_labels(const SvgPanel& panel);
[[nodiscard]] std::string svg_y_labels(const SvgPanel& panel);

// style: the CSS class, and further attributes if any, as in  class="thin" id="a".
[[nodiscard]] std::string svg_curve(const SvgPanel& panel,
                                    std::span<const double> x,
                                    std::span<const double> y,
                                    std::string_view style);
[[nodiscard]] std::string svg_dots(const SvgPanel& panel,
                                   std::span<const double> x,
                                   std::span<const double> y,
                                   std::string_view style);

enum class SvgAnchor { Start, Middle, End };
[[nodiscard]] std::string svg_text(
    double x_px, double y_px, SvgAnchor anchor, std::string_view style, std::string_view text);

// Turned to read upwards, centred on the point.
[[nodiscard]] std::string svg_upward_text(double x_px,
                                          double y_px,
                                          std::string_view style,
                                          std::string_view text);

// A whole <svg> of the elements, which a page's style may scale.
[[nodiscard]] std::string svg_drawing(std::string_view id,
                                      double width,
                                      double height,
                                      std::string_view elements);

}  // namespace aphotic
