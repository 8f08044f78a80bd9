// SPDX-License-Identifier: BSD-3-Clause
//
// Before a fit, in the light of the initial rig: poses of other images, and swapped red and blue
// (survey_check.h). After it, signs that its model does not fit the images:
//
//   saturation  more than kMostSaturation of all samples, which the fit omits
//   pattern     residuals that stay in place from image to image (fixed_pattern.h)
//   range       a number farther from the rig's than kFarthest prior spreads
//
// Floors of varying brightness, patches, and errors of the poses are not reported: the fit allows
// for them.
#pragma once

#include "survey/fit/fit.h"
#include "survey/fit/fit_objective.h"
#include "survey/fit/fit_samples.h"
#include "survey/survey_check.h"

#include <optional>
#include <vector>

namespace aphotic {

inline constexpr double kMostSaturation = 0.02;
inline constexpr double kFarthest = 4.0;

[[nodiscard]] std::optional<Suspicion> mistaken_input(const FitSamples& samples,
                                                      const FitObjective& objective,
                                                      const FitProblem& problem,
                                                      const FitLight& light);

[[nodiscard]] std::vector<Suspicion> suspicions(const FitSamples& samples, const FitResult& result);

}  // namespace aphotic
