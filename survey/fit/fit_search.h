// SPDX-License-Identifier: BSD-3-Clause
//
// The search of a fit: from where a problem's numbers are to the least of its objective,
//
//   S = (y - A beta)^T V^-1 (y - A beta) + ties + sum_k ((theta_k - rig's) / plausible_k)^2
//
// with the shares beta eliminated (fit.h, fit_equations.h): once, or with noise, weights and poses
// learned in rounds.
#pragma once

#include "rig/file/rig_text.h"
#include "survey/fit/fit_equations.h"
#include "survey/fit/fit_light.h"
#include "survey/fit/fit_problem.h"
#include "survey/fit/fit_samples.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace aphotic {

// What a search works with. In place, for the equations refer to the light.
struct FitBench {
    // An InputError where no image sees the floor.
    FitBench(const RigText& rig, const FitSamples& samples, int threads);
    FitBench(const FitBench&) = delete;
    FitBench& operator=(const FitBench&) = delete;

    [[nodiscard]] PathLight path_light(const FitState& state, bool has_derivatives) const {
        return {rig, state.water, state.floor, paths, has_derivatives};
    }

    const RigText& rig;
    FitLight light;
    FitEquations equations;
    std::vector<Sled> sleds;
    PathRange paths;
    bool learns_effects = false;  // their variances
};

// An answer's light, and what of it each part has.
struct LitAnswer {
    PathLight light;
    Eigen::VectorXd shares;
};
// An InputError where no light at all is best.
[[nodiscard]] LitAnswer lit_by(const FitBench& bench, const FitProblem& problem);

// The same with slopes, and its normal equations with what a sandwich wants.
struct Linearised {
    PathLight light;
    Eigen::VectorXd shares;
    FitEquations::Normal normal;
};
[[nodiscard]] Linearised linearised_at(const FitBench& bench, const FitProblem& problem);

// S at the problem's state, the shares as they are best there.
[[nodiscard]] double objective(const FitBench& bench, const FitProblem& problem);

// Gains that bring each channel's light to the images': the search begins there, for a camera's
// gains may be anything.
void start_gains(const FitBench& bench, FitProblem& problem);

// Ties, noise and poses as this answer leaves them.
void learn(FitBench& bench, const FitProblem& problem, Robust robust);

// The noise that this answer leaves, for excess: with Huber's weights, for by the biweight what
// speaks against another answer counts as stones, and without ties, which are each answer's own.
void learn_to_compare(FitBench& bench, const FitProblem& answer);

// S of one answer less S of another to the same images: the mean of what it is under the noise that
// either leaves, as learned to compare.
[[nodiscard]] double excess(const FitBench& bench,
                            const FitProblem& answer,
                            const FitBench& other_bench,
                            const FitProblem& other);

// Variances of what images share, at first.
[[nodiscard]] EffectVariances first_effects(const FitOptions& options, bool are_maps);

// Moves the problem's state to its answer, whatever was learned before: a search by assumed noise,
// then kRobustRounds. Steps that it took.
int search_in_rounds(FitBench& bench,
                     FitProblem& problem,
                     const EffectVariances& first,
                     const std::function<void(double share)>& progress);
// The rounds alone, from an answer: without a first search, which the assumed noise may lead away.
int search_on(FitBench& bench,
              FitProblem& problem,
              const EffectVariances& first,
              const std::function<void(double share)>& progress);

}  // namespace aphotic
