// SPDX-License-Identifier: BSD-3-Clause
//
// Before a fit, by the light of the rig that it begins with: poses of other images, and red and
// blue that are swapped (survey_check.h). After it, signs that its model is not the images':
//
//   saturation  more than kMostSaturation of all samples, which the fit leaves out
//   pattern     residuals that stay in place from image to image by more than kMostPattern rms, and
//               kPatternSigmas of chance
//   range       a number farther from the rig's than kFarthest spreads beforehand
//
// Floors that are brighter here than there, patches, and poses that are off are no sign of
// anything: the fit allows for them.
#pragma once

#include "survey/fit/fit.h"
#include "survey/fit/fit_objective.h"
#include "survey/fit/fit_samples.h"
#include "survey/survey_check.h"

#include <optional>
#include <vector>

namespace aphotic {

inline constexpr double kMostSaturation = 0.02;
inline constexpr double kMostPattern = 0.02;
inline constexpr double kPatternSigmas = 4.0;
inline constexpr double kFarthest = 4.0;

[[nodiscard]] std::optional<Suspicion> mistaken_input(const FitSamples& samples,
                                                      const FitObjective& objective,
                                                      const FitProblem& problem,
                                                      const FitLight& light);

[[nodiscard]] std::vector<Suspicion> suspicions(const FitSamples& samples, const FitResult& result);

}  // namespace aphotic
