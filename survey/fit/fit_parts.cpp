// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_parts.h"

#include "survey/fit/fit_told.h"

#include <Eigen/Cholesky>

#include <cmath>
#include <list>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Rung {
    Rung(const RigText& rig,
         const FitSamples& samples,
         const FitOptions& options,
         const FitAngles& angles)
        : bench(rig, samples, options.threads), problem(fit_problem(rig, options, angles)) {}

    FitBench bench;
    FitProblem problem;
    double cost = 0.0;  // ln(n) tr(H^-1 M)
};

// ln(n) tr(H^-1 M), of the shares that are not 0 and the numbers.
double cost_of(const FitBench& bench, const FitProblem& problem) {
    const Linearised at = linearised_at(bench, problem);
    const Index parts = at.shares.size();
    const Index count = std::ssize(problem.free);
    std::vector<Index> rows = active_parts(at.shares);
    for (Index k = 0; k < count; ++k) rows.push_back(parts + k);
    MatrixXd H = at.normal.H(rows, rows);
    H.diagonal().tail(count) += problem.plausible().cwiseAbs2().cwiseInverse();
    const VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
    const auto scaled = [&](const MatrixXd& of) {
        return MatrixXd(scale.asDiagonal() * of * scale.asDiagonal());
    };
    const double fitted = scaled(H).ldlt().solve(scaled(at.normal.meat(rows, rows))).trace();
    return std::log(static_cast<double>(at.normal.tiles)) * fitted;
}

// By how much the rung is worse.
double excess_over(const Rung& best, const Rung& rung) {
    return excess(rung.bench, rung.problem, best.bench, best.problem) + rung.cost - best.cost;
}

void answer(const FitSamples& samples,
            const FitOptions& options,
            const FitProblem* before,
            Rung& rung) {
    start_gains(rung.bench, rung.problem);
    if (before) rung.problem.state = rung.problem.at(before->now().data());
    search_in_rounds(
        rung.bench, rung.problem, first_effects(options, samples.are_maps), [](double) {});
    learn_to_compare(rung.bench, rung.problem);
    rung.cost = cost_of(rung.bench, rung.problem);
}

}  // namespace

FitProblem with_told_parts(const RigText& rig,
                           const FitSamples& samples,
                           const FitOptions& options,
                           const FitAngles& angles,
                           const RunWatch& watch) {
    constexpr int kMostWorse = 2;
    std::list<Rung> rungs;
    const Rung* best = nullptr;
    int worse = 0;
    for (const std::size_t parts : kRungs) {
        watch.progress("choosing the beam's parts",
                       static_cast<double>(rungs.size()) / static_cast<double>(kRungs.size()));
        FitOptions own = options;
        own.parts = parts;
        const FitProblem* before = rungs.empty() ? nullptr : &rungs.back().problem;
        Rung& rung = rungs.emplace_back(rig, samples, own, angles);
        answer(samples, own, before, rung);
        const bool is_better = best == nullptr || excess_over(*best, rung) < 0.0;
        if (is_better) best = &rung;
        worse = is_better ? 0 : worse + 1;
        if (worse == kMostWorse) break;
    }
    return best->problem;
}

}  // namespace aphotic
