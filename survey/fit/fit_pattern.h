// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit leaves in place from image to image: where that is more than texture makes by chance,
// the light is none that the fit allows.
//
// A pair of neighbouring blocks is off by d_i in image i, whose t has the weight w_i there. Over
// images
//
//   D = sum w d / sum w       z^2 = (sum w d)^2 / sum (w d)^2        mean 1 by chance
//
// and the pattern is the field whose differences are closest to the D of green.
#pragma once

#include "survey/fit/fit.h"
#include "survey/fit/fit_objective.h"

namespace aphotic {

[[nodiscard]] FitPattern pattern_of(const FitObjective& objective,
                                    const FitPoint& point,
                                    const FitPlaces& places);

}  // namespace aphotic
