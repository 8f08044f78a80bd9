// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit_jackknife.h"

#include "base/non_negative_fit.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Shares and numbers.
struct Answer {
    VectorXd shares;
    FitProblem problem;
};

std::vector<Index> free_of_bounds(const FitProblem& problem) {
    std::vector<Index> all;
    FitState state = problem.state;
    for (std::size_t k = 0; k < problem.free.size(); ++k) {
        const FreeNumber& one = problem.free[k];
        const double value = number_in(state, one.number);
        if (value > one.least && value < one.most) all.push_back(static_cast<Index>(k));
    }
    return all;
}

// To the least of the objective, were it a quadric: the numbers are eliminated, and the shares that
// remain are not negative.
void step(const FitEquations::Normal& normal, Answer& answer) {
    const Index parts = answer.shares.size();
    const std::vector<Index> moving = free_of_bounds(answer.problem);
    const MatrixXd of_shares = normal.H.topLeftCorner(parts, parts);
    const VectorXd b = normal.gradient.head(parts) + of_shares * answer.shares;
    if (moving.empty()) {
        answer.shares = non_negative_fit(of_shares, b);
        return;
    }
    // Each number over what is plausible.
    const VectorXd start = answer.problem.start();
    VectorXd x = answer.problem.now();
    const VectorXd scale = answer.problem.plausible()(moving);
    const Index count = x.size();
    MatrixXd S = scale.asDiagonal() * normal.H.bottomRightCorner(count, count)(moving, moving) *
                 scale.asDiagonal();
    S.diagonal().array() += 1.0;
    const MatrixXd across =
        scale.asDiagonal() * normal.H.bottomLeftCorner(count, parts)(moving, Eigen::all);
    const VectorXd b_numbers = scale.cwiseProduct(VectorXd(normal.gradient.tail(count)(moving))) +
                               VectorXd((start - x)(moving)) + across * answer.shares;
    const Eigen::LLT<MatrixXd> solver(S);
    answer.shares = non_negative_fit(of_shares - across.transpose() * solver.solve(across),
                                     b - across.transpose() * solver.solve(b_numbers));
    const VectorXd moves = solver.solve(b_numbers - across * answer.shares);
    for (Index i = 0; i < moves.size(); ++i) {
        const Index k = moving[static_cast<std::size_t>(i)];
        const FreeNumber& one = answer.problem.free[static_cast<std::size_t>(k)];
        x(k) = std::clamp(x(k) + moves(i), one.least / one.plausible, one.most / one.plausible);
    }
    answer.problem.state = answer.problem.at(x.data());
}

}  // namespace

VectorXd jackknife(const FitEquations& equations,
                   const FitProblem& problem,
                   const LightOf& light_of,
                   const VectorXd& shares,
                   std::size_t groups,
                   const RunWatch& watch) {
    const auto count = static_cast<double>(groups);
    std::vector<VectorXd> found;
    for (std::size_t group = 0; group < groups; ++group) {
        watch.progress("estimating errors", static_cast<double>(group) / count);
        Answer answer{.shares = shares, .problem = problem};
        for (const Robust robust : kRobustRounds) {
            const FitState& state = answer.problem.state;
            step(equations.without(group,
                                   groups,
                                   state,
                                   light_of(state),
                                   answer.shares,
                                   problem.numbers(),
                                   robust),
                 answer);
        }
        found.push_back(values_of(answer.shares, answer.problem));
    }
    VectorXd mean = VectorXd::Zero(found.front().size());
    for (const VectorXd& one : found) mean += one / count;
    VectorXd variances = VectorXd::Zero(mean.size());
    for (const VectorXd& one : found) variances += (one - mean).cwiseAbs2();
    return variances * (count - 1.0) / count;
}

}  // namespace aphotic
