// SPDX-License-Identifier: BSD-3-Clause
//
// Variances of what is fitted by the jackknife: what the answer moves by as each of
// kJackknifeGroups groups of images is left out in turn, x_g,
//
//   variance = (n - 1) / n sum over the n groups of (x_g - mean of these)^2
//
// (B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans, 1982, 3.1, of groups). Each
// x_g is sought from the answer by kRobustRounds steps of Gauss and Newton, each with weights
// found anew, Huber's first, so that none is kept because an image gave it to itself. Noise and
// poses stay as the answer has them, shares 0 or more, and numbers at a bound where they are.
#pragma once

#include "survey/fit_equations.h"
#include "survey/fit_problem.h"
#include "survey/run_watch.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kJackknifeGroups = 12;

// The light of a state, with slopes.
using LightOf = std::function<PathLight(const FitState&)>;

// Variances of the shares, then of the numbers. At most as many groups as there are images.
[[nodiscard]] Eigen::VectorXd jackknife(const FitEquations& equations,
                                        const FitProblem& problem,
                                        const LightOf& light_of,
                                        const Eigen::VectorXd& shares,
                                        std::size_t groups,
                                        const RunWatch& watch);

}  // namespace aphotic
