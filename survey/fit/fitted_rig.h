// SPDX-License-Identifier: BSD-3-Clause
//
// A fit as a rig: the original file with its fitted keys, and the files that it names, beside it.
// It is used like any other rig, by `correct` and all other commands.
//
//   beam         [beam.fitted], or for several [beam.fitted-1] and so on: a table beside it, or the
//                rig's with other shares or optics
//   aim          `direction` of each strobe
//   power        of each strobe in its own unit, times the flux that its beam has in the fit; their
//                sum is unchanged. If neither beams nor powers were fitted, the strobes' figures
//                stay.
//   water        the keys of [water]
//   vignetting   { cosine = n } or { radial = [...] }
//   floor        the rig's reflectance times the brightness from the veil, fitted-floor.csv
//   offsets      added to altitude_offset_m, and to the camera's orientation_deg
//
// The colour of the images' floor is not part of a rig, whose map is that of its own floor: it is
// in fit.json.
#pragma once

#include "survey/fit/fit.h"

#include <filesystem>

namespace aphotic {

inline constexpr const char* kFittedRig = "fitted.toml";
inline constexpr const char* kFittedFloor = "fitted-floor.csv";
inline constexpr const char* kFitNumbers = "fit.json";
inline constexpr const char* kFitPage = "report.html";

// The folder must exist. Files are complete or absent; the rig is written last.
void write_fitted_rig(const RigText& rig,
                      const FitResult& result,
                      const std::filesystem::path& folder);

}  // namespace aphotic
