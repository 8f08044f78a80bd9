// SPDX-License-Identifier: BSD-3-Clause
//
// Heights on a grid, from a GeoTIFF (OGC 19-008r4) in metres of a map projection, north up:
//
//   east  = X + (column + a - I) s_x        ModelTiepoint I, J, -, X, Y, -
//   north = Y - (row + a - J) s_y           ModelPixelScale s_x, s_y, -
//
// of the sample's middle: a is 1/2 if a sample represents its cell, by default, and 0 if it
// represents a point (GTRasterType). Samples are integers or floats of up to 64 bits, of one
// channel; those equal to GDAL's nodata and those that are not finite are unknown.
//
// Refused: degrees, other units, rotated grids, and integers that a scale or offset converts to
// heights (GDAL's metadata).
#pragma once

#include <filesystem>
#include <vector>

namespace aphotic {

struct HeightGrid {
    int width = 0;
    int height = 0;
    double east_m = 0.0;  // of the first sample
    double north_m = 0.0;
    double step_east_m = 0.0;
    double step_south_m = 0.0;
    std::vector<float> height_m{};  // row by row, as in the file; NaN: unknown
};

// An InputError, which names the file, if it has no such grid.
[[nodiscard]] HeightGrid read_height_grid(const std::filesystem::path& file);

}  // namespace aphotic
