// SPDX-License-Identifier: BSD-3-Clause
//
// Plots of curves over x as an SVG file of its own. Panels are one above the other in one picture,
// with their frames aligned.
//
// x extends from the least to the largest value given. y starts at 0 if the curves come near it.
// With log_y, points at or below 0 are omitted and the line is broken there. So are points that are
// not finite.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

struct PlotCurve {
    std::string label;  // in the legend; omitted if empty
    std::vector<double> x;
    std::vector<double> y;
    std::size_t tone = 0;  // of kTones
    bool dashed = false;
    std::vector<std::string> points = {};  // names of the points, which are then marked
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
};

// The panels from top to bottom, as one <svg>. Throws InputError if there is no panel, or if no
// point can be drawn in one of them.
[[nodiscard]] std::string plots_svg(std::span<const Plot> panels);

// The same to a file. Also throws InputError for an extension other than .svg, and RunError if the
// file cannot be written. The file is complete or absent.
void write_plots(std::span<const Plot> panels, const std::filesystem::path& file);

}  // namespace aphotic
