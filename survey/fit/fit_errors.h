// SPDX-License-Identifier: BSD-3-Clause
//
// How far a fit can be off. The covariance of its numbers is
//
//   C = F A^-1 (sum over images s s^T + R^T R) A^-1 F,     A = sum over images H + R^T R
//
// H  curvature of an image's part of S/2          s  its gradient, (1 - H A^-1)^-1 of that at the
// R  what is known beforehand (fit_problem.h)        answer: as though the answer were made without
//                                                    the image (CR3)
//
// It holds however noise and texture of an image hang together, for images are independent. The
// same two sums tell how much less an image says than its likelihood:
//
//   phi = trace(A^-1 sum s s^T) / trace(A^-1 sum H)          the dispersion, at least 1
//
// All this takes light for linear within the errors. Aims that make up for each other are not:
// their errors would be half of what they are. F is what two halves of the survey differ by over
// what C says of such halves, for each kind of number, and as far as these are few, for all
// together; the geometric mean over kSplits pairs of halves, for now and then one is lost, and at
// least 1. It is measured alike for the map.
//
// Fewer than kFewestImages that count tell neither: their dispersion is what it was,
// kFirstDispersion, of patchy floors, and C = A^-1.
//
// K.-Y. Liang and S. L. Zeger, Biometrika 73, 1986, 13 (sandwich); R. M. Bell and D. F. McCaffrey,
// Survey Methodology 28, 2002, 169 (CR3); F. Pauli, W. Racugno and L. Ventura, Statistica Sinica
// 21, 2011, 149 (dispersion); P. J. McCarthy, Rev. Int. Stat. Inst. 37, 1969, 239 (halves).
#pragma once

#include "survey/fit/fit_objective.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>

namespace aphotic {

inline constexpr std::size_t kFewestImages = 16;
// A word's own numbers count against so many of all words together.
inline constexpr double kOfAll = 3.0;
inline constexpr std::size_t kSplits = 2;
// The poses of the flight that the map's error is the mean over, at most.
inline constexpr std::size_t kFewPoses = 12;

[[nodiscard]] double dispersion_at(const FitObjective& objective, const FitPoint& point);

// Numbers less what all powers have in common, which no image tells and no map asks for.
[[nodiscard]] Eigen::MatrixXd without_common_power(const FitProblem& problem);

struct FitErrors {
    Eigen::MatrixXd covariance;  // of the problem's numbers, less the common power
    double unevenness = 0.0;     // of the map's logarithm over the flight, its mean left out; rms
};
// half(split, which): the answer of half of the images that count.
[[nodiscard]] FitErrors errors_of(const FitObjective& objective,
                                  const FitProblem& problem,
                                  const FitPoint& point,
                                  const std::function<FitPoint(std::size_t, std::size_t)>& half);

}  // namespace aphotic
