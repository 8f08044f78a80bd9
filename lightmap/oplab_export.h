// SPDX-License-Identifier: BSD-3-Clause
//
// Maps over altitude as the parameters that oplab's correct_images learns from a survey, so that it
// can correct one with a model: a folder of NumPy arrays, at the rig's own pitch, roll and water.
//
//   attenuation_parameters.npy  [channel, row, column, 3]  a, b [1/m], c of f(h) = a exp(b h) + c,
//                               fitted with a >= 0, b <= 0 and 0 <= c <= the least light, so that
//                               no divisor crosses zero (altitude_fit.h)
//   correction_gains.npy        [channel, row, column]     f at the mean of the altitudes
//   image_corrected_mean.npy    [row, column, channel]     the gains once more
//   image_corrected_std.npy     [row, column, channel]     kContrastOverBrightness of them
//
// In water that scatters, f is fitted to the signal, floor and veil: c then carries the veil's
// limit at high altitude.
//
// oplab computes (I gain / f(h) - mean) / std contrast + brightness of an image I, by default with
// a brightness of 30 % and a contrast of 3 %. With these arrays that is 0.3 I / f(h): the image
// divided by its light and nothing else. a, c and the gains may be in any unit, mean and std are in
// that of I: multiply both by the factor from map to image (aphotic compare --scale).
//
// A pixel without light has a = 1, b = c = 0, as in oplab, a mean of 0 and a std of 1.
//
// github.com/ocean-perception/oplab_pipeline, correct_images.
#pragma once

#include "lightmap/lightmap.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <vector>

namespace aphotic {

inline constexpr double kContrastOverBrightness = 3.0 / 30.0;
inline constexpr double kOplabOff = 0.1;

struct AltitudeExport {
    std::vector<double> altitude_m;  // four or more, increasing
    LightmapOptions map;
    std::function<void(double)> progress;  // share of the work
};

struct ExportedOplab {
    // The residuals of all fits, relative to a pixel's mean over altitude.
    double rms = 0.0;
    double worst = 0.0;
    // The share of all maps' lit samples for which the fit is off by more than kOplabOff.
    double share_off = 0.0;
};

// The folder must exist; files of an earlier run are removed.
ExportedOplab export_oplab(const std::filesystem::path& folder,
                           const Rig& rig,
                           const AltitudeExport& request);

[[nodiscard]] nlohmann::ordered_json to_json(const ExportedOplab& made);

}  // namespace aphotic
