// SPDX-License-Identifier: BSD-3-Clause
//
// Chooses the wavelengths: the fewest, in whole frames, that achieve a tolerance.
//
// For n = step, 2 step, ... wavelengths it looks for those whose fitted weights
// (spectral/quadrature_fit.h) err least over the family of light, and stops at the first n whose
// promise is within the tolerance. If fewer wavelengths than the frames hold do as well, as in
// clear water, where one suffices, it takes the fewer.
//
// The search starts from wavelengths spread evenly over the light and over the range, and for up to
// three also from the best of all sets of every third place. Each wavelength in turn moves to the
// best of kCandidates places until none improves; then each, and each with its neighbour, moves in
// steps that halve down to kFinestStepNm. The result is a local optimum, and always the same.
//
// The tolerance is for the whole image, including the frames' rounding; it cannot be below
// frame_error.
#pragma once

#include "spectral/quadrature_fit.h"

#include <span>

namespace aphotic {

struct PlanTarget {
    double tolerance = 1e-3;
    double frame_error = kFrameError;
    int step = 3;  // wavelengths per frame
    int most = 24;
};

inline constexpr int kCandidates = 64;
inline constexpr double kFinestStepNm = 0.125;

// If no rule of up to target.most wavelengths achieves the tolerance, the result is the one with
// the best promise, which shows it.
[[nodiscard]] FittedRule plan_wavelengths(const QuadratureFitter& fitter,
                                          WavelengthRange range,
                                          const PlanTarget& target);

// The best `count` wavelengths in addition to `given`, whose frames exist already. If the first
// trial is far from an error of `budget`, the search stops there.
[[nodiscard]] std::vector<double> best_wavelengths(const QuadratureFitter& fitter,
                                                   WavelengthRange range,
                                                   int count,
                                                   double frame_error,
                                                   std::span<const FrameLight> given = {},
                                                   double budget = 1.0);

}  // namespace aphotic
