// SPDX-License-Identifier: BSD-3-Clause
//
// The errors of a fit. The covariance of its numbers is
//
//   C = F A^-1 (sum over images s s^T + R^T R) A^-1 F,     A = sum over images H + R^T R
//
// H  curvature of an image's part of S/2      s  its gradient, (1 - H A^-1)^-1 of that at the
// R  the prior (fit_problem.h)                   solution: as if the image had been left out of the
//                                                fit (CR3)
//
// It holds whatever the correlation of noise and texture within an image, since images are
// independent. The same two sums give the information in an image relative to its likelihood:
//
//   phi = trace(A^-1 sum s s^T) / trace(A^-1 sum H)          the dispersion, at least 1
//
// All this treats the light as linear within the errors. For aims that compensate for each other it
// is not, and their errors would be half of the true ones. F is the difference between two halves
// of the survey relative to what C predicts for such halves, for each kind of number, and for all
// together as far as the numbers of a kind are few; it is the geometric mean over kSplits pairs of
// halves, since one is occasionally lost, and at least 1. It is determined likewise for the map.
// Errors of aims remain too small, for a reason that is not known: halves that start a prior's
// spread apart end alike. Over forty random surveys (bench/fit_bench) aims were off by kAimWidening
// times their errors, rms, so these are multiplied by it as well.
//
// Fewer than kFewestImages that count determine neither: their dispersion stays kFirstDispersion,
// typical of patchy floors, and C = A^-1.
//
// K.-Y. Liang and S. L. Zeger, Biometrika 73, 1986, 13 (sandwich); R. M. Bell and D. F. McCaffrey,
// Survey Methodology 28, 2002, 169 (CR3); F. Pauli, W. Racugno and L. Ventura, Statistica Sinica
// 21, 2011, 149 (dispersion); P. J. McCarthy, Rev. Int. Stat. Inst. 37, 1969, 239 (halves).
#pragma once

#include "survey/fit/fit_objective.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace aphotic {

inline constexpr std::ptrdiff_t kFewestImages = 16;
// The weight of all numbers together against a word's own numbers.
inline constexpr double kOfAll = 3.0;
inline constexpr std::size_t kSplits = 2;
inline constexpr double kAimWidening = 1.7;
// The most poses of the flight over which the map's error is averaged.
inline constexpr std::size_t kFewPoses = 12;

[[nodiscard]] double dispersion_at(const FitObjective& objective, const FitPoint& point);

// The derivatives of the fitted rig's numbers by those of the fit: the common scale of all powers,
// which images do not determine and maps do not need, is left out. powers: powers_in().
[[nodiscard]] Eigen::MatrixXd without_common_power(const FitProblem& problem,
                                                   const std::vector<double>& powers);

struct FitErrors {
    Eigen::MatrixXd covariance;  // of the problem's numbers, less the common power
    double unevenness = 0.0;     // of the map's logarithm over the flight, less its mean; rms
};
// half(split, which): the solution for half of the images that count.
[[nodiscard]] FitErrors errors_of(const FitObjective& objective,
                                  const FitProblem& problem,
                                  const FitPoint& point,
                                  const std::vector<double>& powers,
                                  const std::function<FitPoint(std::size_t, std::size_t)>& half);

}  // namespace aphotic
