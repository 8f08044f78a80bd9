// SPDX-License-Identifier: BSD-3-Clause
//
// Plots of curves over x, as an SVG file of its own or as part of a page. Panels are one above the
// other in one picture, with their frames aligned.
//
// x extends from the least to the largest value given. y starts at 0 if the curves come near it.
// With log_y, points at or below 0 are omitted and the line is broken there. So are points that are
// not finite.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct PlotCurve {
    std::string label;  // in the legend; omitted if empty
    std::vector<double> x;
    std::vector<double> y;
    std::size_t tone = 0;  // of kTones
    bool dashed = false;
    std::vector<std::string> points = {};  // names of the points, which are then marked
    bool dots = false;                     // marks the points, without a line
};

struct Plot {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<PlotCurve> curves;
    bool log_y = false;
    // A unit has the same length in x and y: the shorter range is widened about its middle. Not
    // with log_y.
    bool equal_axes = false;
    // Thin dashed grey lines from bottom to top, behind the curves; none outside the x axis.
    std::vector<double> marks_x = {};
    bool from_zero = false;  // y starts at 0, wherever the curves are
};

// The panels from top to bottom, as one <svg> of that id. Each has this height with its
// surroundings; the width is 960. A page has the style of plots and headings of its own: the titles
// are for screen readers only. Throws InputError if there is no panel, or if no point can be drawn
// in one of them.
[[nodiscard]] std::string page_plot(std::string_view id,
                                    std::span<const Plot> panels,
                                    double height);

// The same as a file with style and titles. Also throws InputError for an extension other than
// .svg, and RunError if the file cannot be written. The file is complete or absent.
void write_plots(std::span<const Plot> panels, const std::filesystem::path& file);

}  // namespace aphotic
