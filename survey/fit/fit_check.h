// SPDX-License-Identifier: BSD-3-Clause
//
// Before a fit, by the light of the rig that it begins with: poses of other images, and red and
// blue that are swapped (survey_check.h). After it, signs that its model is not the images', or
// that its errors may not hold:
//
//   pattern     residuals that stay in place from image to image, over kMostPattern rms
//   altitude    brightness left of kFewestImages or more that goes with the altitude, over
//               kMostTrend rms, its correlation over kTrendSigmas of what chance makes of as many
//   exposure    brightness left of the images over kMostLevel rms: other poses, other exposures
//   range       a number farther from the rig's than kFarthest times what is plausible, or at the
//               end of its range
//   errors      over kMostError of what is plausible: by itself the number seems to be told, but
//               halves of the images give others, or a number that is held leaves it open
//   altitudes   the highest within kOneAltitude times the lowest, beam and water or lens free: they
//               nearly make up for each other, and what the model lacks goes where it costs least
//   maps        what residuals of neighbouring blocks of maps share, over kMostShared of all that
//               is left, but at least kLeastTexture and at most kMostTexture rms: texture that was
//               not averaged out, or light that the model lacks, is alike over wide parts of a map,
//               and errors do not allow for it
//   saturation  more than kMostSaturation of all samples, which the fit leaves out
#pragma once

#include "survey/fit/fit.h"
#include "survey/fit/fit_samples.h"
#include "survey/survey_check.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace aphotic {

inline constexpr double kMostPattern = 0.02;
inline constexpr std::size_t kFewestImages = 10;
inline constexpr double kMostTrend = 0.02;  // of a rough floor more is resolved from nearby
inline constexpr double kTrendSigmas = 4.0;
inline constexpr double kMostLevel = 0.25;
inline constexpr double kFarthest = 3.0;
inline constexpr double kMostError = 0.5;
inline constexpr double kOneAltitude = 1.25;
inline constexpr double kLeastTexture = 0.0005;
inline constexpr double kMostTexture = 0.003;
// By chance noise shares a (number of blocks)^-1/4 of itself: 0.14 of five maps of 16 x 12.
inline constexpr double kMostShared = 0.3;
inline constexpr double kMostSaturation = 0.02;

[[nodiscard]] std::optional<Suspicion> mistaken_input(const FitSamples& samples,
                                                      const FitLight& fit_light,
                                                      const FitState& state,
                                                      const PathLight& light,
                                                      const Eigen::VectorXd& shares);

[[nodiscard]] std::vector<Suspicion> suspicions(const FitSamples& samples, const FitResult& result);

}  // namespace aphotic
