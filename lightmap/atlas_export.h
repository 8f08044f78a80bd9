// SPDX-License-Identifier: BSD-3-Clause
//
// Maps over altitude in the shapes that correctors of surveys use, at the rig's own pitch, roll and
// water. Each map is computed at its altitude, none is interpolated.
//
//   bayer        FOLDER/altitude_1.00m.exr, one a step: the channel Y is the sensor's mosaic RGGB,
//                R in even rows and columns counted from 0, B in odd ones, G in the others
//   exponential  one file: per pixel and channel a exp(b h) + c (altitude_fit.h), in channels a.R,
//                b.R, c.R, residual.R and so on
#pragma once

#include "lightmap/lightmap.h"

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace aphotic {

struct AltitudeExport {
    std::vector<double> altitude_m;
    LightmapOptions map;
    std::function<void(double)> progress;  // share of the work
};

void export_bayer(const std::filesystem::path& folder,
                  const Rig& rig,
                  const AltitudeExport& request);

// The residuals of all fits: relative to the mean of a pixel over altitude.
struct FitResiduals {
    double rms = 0.0;
    double worst = 0.0;
};
FitResiduals export_exponential(const std::filesystem::path& file,
                                const Rig& rig,
                                const AltitudeExport& request);

// The mosaic RGGB of a map of an even or odd size.
[[nodiscard]] std::vector<float> mosaic_rggb(const Lightmap& map);

}  // namespace aphotic
