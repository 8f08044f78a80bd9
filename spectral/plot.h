// SPDX-License-Identifier: BSD-3-Clause
//
// Line plots of curves over x, as .png (1920 x 1200 px) or .svg by the file's extension. One
// drawing for both.
//
// x runs from the least to the largest value given. y starts at 0 when the curves come near
// it. With log_y, points at or below 0 are left out and the line is broken there. Points that
// are not finite are left out likewise.
#pragma once

#include <filesystem>
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

struct PlotCurve {
    std::string label;  // in the legend; left out when empty
    std::vector<double> x;
    std::vector<double> y;
    PlotColour colour = kPlotBlue;
};

struct Plot {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<PlotCurve> curves;
    bool log_y = false;
};

// Throws InputError for another extension or when no point can be drawn, RunError when the file
// cannot be written. The file is whole or not there.
void write_plot(const Plot& plot, const std::filesystem::path& file);

}  // namespace aphotic
