// SPDX-License-Identifier: BSD-3-Clause
//
// Plots of curves over x, as lines or as points, as .png (1920 x 1200 px a panel) or .svg by the
// file's extension. One drawing for both. Panels stand one above the other in one picture, their
// frames aligned.
//
// x runs from the least to the largest value given. y starts at 0 when the curves come near
// it. With log_x or log_y, points at or below 0 are left out and the line is broken there. Points
// that are not finite are left out likewise.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// sRGB, 0 to 1.
struct PlotColour {
    double red = 0.0;
    double green = 0.0;
    double blue = 0.0;
};

inline constexpr PlotColour kPlotBlue{0.12, 0.38, 0.66};
inline constexpr PlotColour kPlotRed{0.80, 0.20, 0.18};
inline constexpr PlotColour kPlotGreen{0.16, 0.55, 0.27};

// For more curves: each stands out from white and from every other.
inline constexpr std::array<PlotColour, 8> kPlotPalette{kPlotBlue,
                                                        kPlotRed,
                                                        kPlotGreen,
                                                        {0.87, 0.47, 0.03},   // orange
                                                        {0.48, 0.25, 0.66},   // violet
                                                        {0.06, 0.58, 0.66},   // turquoise
                                                        {0.42, 0.27, 0.14},   // brown
                                                        {0.86, 0.30, 0.62}};  // pink

struct PlotCurve {
    std::string label;  // in the legend; left out when empty
    std::vector<double> x;
    std::vector<double> y;
    PlotColour colour = kPlotBlue;
    bool dashed = false;
    bool points = false;  // a filled circle at each point instead of the line
    // Small text beside the points, in their order; may be shorter, empty ones are left out. Each
    // stays within the panel and moves aside for points, lines and other labels.
    std::vector<std::string> point_labels = {};
};

struct Plot {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<PlotCurve> curves;
    bool log_y = false;
    bool log_x = false;
    // Thin dashed grey lines from bottom to top, behind the curves; none beyond the x axis.
    std::vector<double> marks_x = {};
};

// The panels from top to bottom. Throws InputError for another extension, when there is no panel,
// or when no point can be drawn in one of them; RunError when the file cannot be written. The file
// is whole or not there.
void write_plots(std::span<const Plot> panels, const std::filesystem::path& file);

// A single panel.
void write_plot(const Plot& plot, const std::filesystem::path& file);

}  // namespace aphotic
