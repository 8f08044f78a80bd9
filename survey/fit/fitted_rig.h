// SPDX-License-Identifier: BSD-3-Clause
//
// A fit as a rig: the file that it began with, its keys as they were fitted, and what the file
// names beside it. A rig as any other, for `correct` and all the rest.
//
//   beam         [beam.fitted], or of several [beam.fitted-1] and so on: a table beside it, or the
//                rig's with other shares or optics
//   aim          `direction` of each strobe
//   power        of each strobe in the unit that it has, times the flux that its beam has by the
//                fit; together as much as before. Where neither beams nor powers were fitted, the
//                strobes' figures stay.
//   water        the keys of [water]
//   vignetting   { cosine = n } or { radial = [...] }
//   floor        the rig's reflectance times the brightness that the veil tells, fitted-floor.csv
//   offsets      added to altitude_offset_m, and to the camera's orientation_deg
//
// The colour of the images' floor is no part of a rig, whose map is that of its own floor: fit.json
// has it.
#pragma once

#include "survey/fit/fit.h"

#include <filesystem>

namespace aphotic {

inline constexpr const char* kFittedRig = "fitted.toml";
inline constexpr const char* kFittedFloor = "fitted-floor.csv";
inline constexpr const char* kFitNumbers = "fit.json";
inline constexpr const char* kFitPage = "report.html";

// The folder is there. Files are whole or not there; the rig comes last.
void write_fitted_rig(const RigText& rig,
                      const FitResult& result,
                      const std::filesystem::path& folder);

}  // namespace aphotic
