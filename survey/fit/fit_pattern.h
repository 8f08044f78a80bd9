// SPDX-License-Identifier: BSD-3-Clause
//
// The residual of a fit that stays in place from image to image: if it exceeds what texture gives
// by chance, the fit's model cannot represent the light.
//
// A pair of neighbouring blocks has the residual difference d_i in image i, where its t has the
// weight w_i. Over images
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
