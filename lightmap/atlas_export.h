// SPDX-License-Identifier: BSD-3-Clause
//
// Maps over altitude, beside an atlas, in the shapes that correctors of surveys use, at the rig's
// own pitch, roll and water. Each map is computed at its altitude, none is interpolated.
//
//   bayer        bayer/altitude_1.00m.exr, one a step: the channel Y is the sensor's mosaic RGGB,
//                R in even rows and columns counted from 0, B in odd ones, G in the others. Names
//                have two digits after the point, or as many as the finest altitude needs
//                In water that scatters veil.Y beside it
//   exponential  exponential.exr: per pixel and channel a exp(b h) + c (altitude_fit.h), of the
//                floor's light and the veil together, in
//   channels a.R,
//                b.R, c.R, residual.R and so on
#pragma once

#include "lightmap/lightmap.h"
#include "lightmap/map_axes.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

struct ExportedMosaic {
    std::string file;
    double altitude_m = 0.0;
};
struct ExportedFit {
    std::string file;
    // The residuals of all fits: relative to the mean of a pixel over altitude.
    double rms = 0.0;
    double worst = 0.0;
};

struct AltitudeExport {
    std::vector<double> altitude_m;
    LightmapOptions map;
    std::function<void(double)> progress;  // share of the work
};

// What they wrote, by file names in the folder.
std::vector<ExportedMosaic> export_bayer(const std::filesystem::path& folder,
                                         const Rig& rig,
                                         const AltitudeExport& request);
ExportedFit export_exponential(const std::filesystem::path& folder,
                               const Rig& rig,
                               const AltitudeExport& request);

// Files of these names that are there.
void remove_exports(const std::filesystem::path& folder);

// At these altitudes, and else as the rig is.
[[nodiscard]] MapAxes axes_at_own_pose(const Rig& rig, const std::vector<double>& altitude_m);

// The mosaic RGGB of a map of an even or odd size.
[[nodiscard]] std::vector<float> mosaic_rggb(const Lightmap& map);

}  // namespace aphotic
