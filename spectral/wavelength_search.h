// SPDX-License-Identifier: BSD-3-Clause
//
// Chooses the wavelengths: the fewest, in whole frames, that keep a tolerance.
//
// For n = step, 2 step, ... wavelengths it looks for those whose fitted weights
// (spectral/quadrature_fit.h) err least over the family of light, and stops at the first n whose
// promise is within the tolerance. Where fewer wavelengths of a frame do as well as all of it, as
// in clear water, where one suffices, it takes the fewer.
//
// The search: from wavelengths spread evenly over the light and over the range, up to three
// also from the best of all sets of every third place, each in turn moves to the best of
// kCandidates places, until none gains; then each, and each with its neighbour, moves in steps
// that halve down to kFinestStepNm. A local optimum, found the same way every time.
//
// The tolerance is that of the whole image, frames' rounding included; it cannot be under
// frame_error.
#pragma once

#include "spectral/quadrature_fit.h"

#include <span>

namespace aphotic {

struct PlanTarget {
    double tolerance = 1e-3;
    double frame_error = kFrameError;
    int step = 3;  // wavelengths that a frame holds
    int most = 24;
};

inline constexpr int kCandidates = 64;
inline constexpr double kFinestStepNm = 0.125;

// Where no rule of up to target.most wavelengths keeps the tolerance, the one that promises most:
// its promise says so.
[[nodiscard]] FittedRule plan_wavelengths(const QuadratureFitter& fitter,
                                          WavelengthRange range,
                                          const PlanTarget& target);

// The best `count` wavelengths beside those of `given`, whose frames are there already. When a
// first look finds them far from an error of `budget`, it is left at that.
[[nodiscard]] std::vector<double> best_wavelengths(const QuadratureFitter& fitter,
                                                   WavelengthRange range,
                                                   int count,
                                                   double frame_error,
                                                   std::span<const FrameLight> given = {},
                                                   double budget = 1.0);

}  // namespace aphotic
