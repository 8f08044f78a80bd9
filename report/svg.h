// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of a plot in SVG: panels with axes, curves and dots in them. Each function returns the text
// of some elements; svg_drawing() combines them in one <svg>. svg.css defines their style.
//
// Points that are not finite, or have no logarithm where one is needed, break a curve.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// Colours for curves and marks: each is distinct from white and from every other.
inline constexpr std::array<std::string_view, 8> kTones{"#1f61a8",   // blue
                                                        "#cc332e",   // red
                                                        "#298c45",   // green
                                                        "#de7808",   // orange
                                                        "#7a40a8",   // violet
                                                        "#0f94a8",   // turquoise
                                                        "#6b4524",   // brown
                                                        "#db4f9e"};  // pink
inline constexpr std::array<std::size_t, 3> kChannelTones{1, 2, 0};  // of R, G, B

// An attribute that gives an element this colour; the colours repeat after the last.
[[nodiscard]] std::string svg_tone(std::size_t tone);

struct SvgTick {
    double value = 0.0;
    std::string label;  // empty: only a grid line
};

struct SvgAxis {
    double first = 0.0;
    double last = 1.0;
    bool log = false;
    std::vector<SvgTick> ticks{};
    int unit_log10 = 0;   // the labels omit this power of ten, which is in the title
    std::string title{};  // without one, the ticks have no labels either

    // 0 at first, 1 at last; NaN where the logarithm does not exist.
    [[nodiscard]] double fraction(double value) const;

    // Such as "e / 10⁻⁴".
    [[nodiscard]] std::string in_unit(std::string_view quantity) const;
};

// Ticks at multiples of 1, 2 or 5 times a power of ten, about `wanted` of them.
[[nodiscard]] SvgAxis linear_axis(double first, double last, int wanted);

// The same from a tick at or below `least` to one at or above `most`; from 0 if that is near.
[[nodiscard]] SvgAxis linear_axis_around(double least, double most, int wanted);

// From 1, 2 or 5 times a power of ten below `least` to one above `most`; both positive. All ticks
// are labelled if there are at most most_labels, else powers of ten.
[[nodiscard]] SvgAxis log_axis(double least, double most, int most_labels = 7);

// The least of 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is at least the value.
[[nodiscard]] double round_up(double value);

// The range of the finite values that were included.
struct ValueRange {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    void include(double value);
    void include(std::span<const double> values);
    [[nodiscard]] bool is_empty() const { return least > most; }
};

struct SvgPanel {
    double left = 0.0;
    double top = 0.0;
    double width = 0.0;
    double height = 0.0;
    SvgAxis x{};
    SvgAxis y{};

    [[nodiscard]] double x_px(double value) const { return left + width * x.fraction(value); }
    [[nodiscard]] double y_px(double value) const {
        return top + height * (1.0 - y.fraction(value));
    }
    [[nodiscard]] double right() const { return left + width; }
    [[nodiscard]] double bottom() const { return top + height; }
};

// The least space for titled axes to the left of the panel, and below it.
inline constexpr double kAxisWidth = 86.0;
inline constexpr double kAxisHeight = 44.0;

// Grid, frame, and for each axis with a title the labels and the title: below, and to the left.
[[nodiscard]] std::string svg_axes(const SvgPanel& panel);

// style: the CSS class, and further attributes if any, as in  class="thin" id="a".
[[nodiscard]] std::string svg_curve(const SvgPanel& panel,
                                    std::span<const double> x,
                                    std::span<const double> y,
                                    std::string_view style);
[[nodiscard]] std::string svg_dots(const SvgPanel& panel,
                                   std::span<const double> x,
                                   std::span<const double> y,
                                   std::string_view style);
// A line at one y, from side to side.
[[nodiscard]] std::string svg_level(const SvgPanel& panel, double y, std::string_view style);

[[nodiscard]] std::string svg_line(
    double x1, double y1, double x2, double y2, std::string_view style);

enum class SvgAnchor { Start, Middle, End };
[[nodiscard]] std::string svg_text(
    double x_px, double y_px, SvgAnchor anchor, std::string_view style, std::string_view text);

// The approximate width of a text in a sans-serif face, for layout.
[[nodiscard]] double text_width(std::string_view text, double font_px);

// An attribute that makes the text smaller if it is wider than the room.
[[nodiscard]] std::string svg_fit(std::string_view text, double font_px, double room);

// A whole <svg> of the elements, which a page's style may scale. name: for screen readers.
[[nodiscard]] std::string svg_drawing(std::string_view id,
                                      std::string_view name,
                                      double width,
                                      double height,
                                      std::string_view elements);

}  // namespace aphotic
