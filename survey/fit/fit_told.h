// SPDX-License-Identifier: BSD-3-Clause
//
// What images tell of a rig, and how sure that is.
//
//   told        the error by the images alone is under kTold of what is plausible
//   confounded  known otherwise, some other group of numbers would make the error much smaller
//
// By the images alone: from H with the beam's shares eliminated, without what is plausible. How to
// fly instead: H and that of as many images again at another altitude.
#pragma once

#include "survey/fit/fit_equations.h"
#include "survey/fit/fit_problem.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kTold = 0.5;

// The two numbers that are told least apart, by the correlation of their errors.
struct Confounded {
    std::string one;
    std::string other;
    double correlation = 0.0;
};

// What the data do not tell, and why.
struct NotTold {
    std::string key;
    double error = 0.0;  // by the data alone, in units of the key
    std::string confounded_with{};
    std::optional<double> fly_at_m{};  // further images that would part them
    double error_then = 0.0;
};

[[nodiscard]] std::string words_of(const NotTold& one);

// The parts that have a share.
[[nodiscard]] std::vector<Eigen::Index> active_parts(const Eigen::VectorXd& shares);

// H of some numbers with some shares eliminated: Kaufman's.
[[nodiscard]] Eigen::MatrixXd eliminated(const Eigen::MatrixXd& H,
                                         const std::vector<Eigen::Index>& parts,
                                         const std::vector<Eigen::Index>& numbers);

// Covariance of shares and numbers, as though no share were bounded; rows of what no image sees
// are 0.
[[nodiscard]] Eigen::MatrixXd covariance_of(const FitEquations::Normal& normal,
                                            const Eigen::VectorXd& shares,
                                            const std::vector<FreeNumber>& free);

// Of numbers whose errors are correlated by more than 0.9, the largest first.
[[nodiscard]] std::vector<Confounded> confounded_in(const Eigen::MatrixXd& covariance,
                                                    Eigen::Index parts,
                                                    const std::vector<FreeNumber>& free);

// H: of the fit. sleds: where its images were taken.
[[nodiscard]] std::vector<NotTold> not_told(const FitEquations& equations,
                                            const FitProblem& problem,
                                            const PathLight& light,
                                            const Eigen::MatrixXd& H,
                                            const Eigen::VectorXd& shares,
                                            const std::vector<Sled>& sleds);

}  // namespace aphotic
