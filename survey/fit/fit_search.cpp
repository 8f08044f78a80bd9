// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_search.h"

#include "base/error.h"
#include "base/non_negative_fit.h"
#include "survey/fit/fit.h"
#include "survey/fit/fit_told.h"

#include <ceres/ceres.h>
#include <glog/logging.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Fewer images do not tell the variances of what they share: held at first_effects', these leave
// to the finest detail all that an even floor tells.
constexpr std::size_t kFewestToLearn = 5;

constexpr int kFirstSteps = 25;
constexpr int kRoundSteps = 12;  // of each round

std::vector<Sled> sleds_of(const FitSamples& samples) {
    std::vector<Sled> sleds;
    for (const FitImage& image : samples.images) sleds.push_back(image.sled);
    return sleds;
}

struct Solved {
    VectorXd shares;
    double squares = 0.0;  // what is left of y^T V^-1 y
};

Solved shares_of(const FitEquations::Parts& parts) {
    const VectorXd shares = non_negative_fit(parts.G, parts.b);
    return {.shares = shares,
            .squares = std::max(
                0.0, parts.squares - 2.0 * parts.b.dot(shares) + shares.dot(parts.G * shares))};
}

std::vector<Index> numbers_after(Index parts, Index count) {
    std::vector<Index> all;
    for (Index i = 0; i < count; ++i) all.push_back(parts + i);
    return all;
}

// H of the numbers, each over what is plausible, the shares eliminated; and of what is plausible.
MatrixXd scaled_hessian(const FitEquations::Normal& normal,
                        const VectorXd& shares,
                        const FitProblem& problem) {
    const VectorXd scale = problem.plausible();
    MatrixXd S =
        scale.asDiagonal() *
        eliminated(normal.H, active_parts(shares), numbers_after(shares.size(), scale.size())) *
        scale.asDiagonal();
    S.diagonal().array() += 1.0;
    return S;
}

// The objective for Ceres, in n + 1 residuals that have its value, gradient and Gauss-Newton
// matrix: all that its trust region asks for. So a million blocks come as some twenty rows.
class Reduced : public ceres::CostFunction {
  public:
    Reduced(const FitBench& bench, const FitProblem& problem) : bench_(bench), problem_(problem) {
        const auto count = static_cast<int>(problem.free.size());
        mutable_parameter_block_sizes()->push_back(count);
        set_num_residuals(count + 1);
    }

    bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
        const bool has_slopes = jacobians != nullptr && jacobians[0] != nullptr;
        const FitState state = problem_.at(x[0]);
        if (!bench_.light.is_bright(state)) return false;
        const auto count = static_cast<Index>(problem_.free.size());
        const PathLight light = bench_.path_light(state, has_slopes);
        const Solved& solved = solved_at(VectorXd::Map(x[0], count), state, light);
        const VectorXd off = VectorXd::Map(x[0], count) - problem_.start();
        const double squares = solved.squares + off.squaredNorm();
        if (!std::isfinite(squares)) return false;
        Eigen::Map<VectorXd> r(residuals, count + 1);
        r.setZero();
        r(count) = std::sqrt(squares);
        if (!has_slopes) return true;
        const FitEquations::Normal normal =
            bench_.equations.normal(state, light, solved.shares, problem_.numbers(), false);
        const MatrixXd S = scaled_hessian(normal, solved.shares, problem_);
        const VectorXd gradient =
            off - problem_.plausible().cwiseProduct(normal.gradient.tail(count));
        // S = L L^T: J = L^T above a row of 0, r = (L^-1 gradient, the rest).
        if (!S.allFinite()) return false;
        const Eigen::LLT<MatrixXd> cholesky(S);
        if (cholesky.info() != Eigen::Success) return false;
        const MatrixXd L = cholesky.matrixL();
        r.head(count) = L.triangularView<Eigen::Lower>().solve(gradient);
        r(count) = std::sqrt(std::max(0.0, squares - r.head(count).squaredNorm()));
        using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<Jacobian> J(jacobians[0], count + 1, count);
        J.setZero();
        J.topRows(count) = L.transpose();
        return true;
    }

  private:
    // Of the place last asked for: Ceres wants the slopes where it has just had the value.
    const Solved& solved_at(const VectorXd& x,
                            const FitState& state,
                            const PathLight& light) const {
        if (x.size() != last_x_.size() || x != last_x_) {
            last_ = shares_of(bench_.equations.parts(state, light));
            last_x_ = x;
        }
        return last_;
    }

    const FitBench& bench_;
    const FitProblem& problem_;
    mutable VectorXd last_x_;
    mutable Solved last_;
};

// Moves the problem's state to the least of the objective. Steps that it took.
int search(const FitBench& bench, FitProblem& problem, int most_steps) {
    if (problem.free.empty()) return 0;
    VectorXd x = problem.now();
    ceres::Problem minimised;
    minimised.AddResidualBlock(new Reduced(bench, problem), nullptr, x.data());
    for (std::size_t k = 0; k < problem.free.size(); ++k) {
        const FreeNumber& one = problem.free[k];
        const auto at = static_cast<int>(k);
        if (std::isfinite(one.least))
            minimised.SetParameterLowerBound(x.data(), at, one.least / one.plausible);
        if (std::isfinite(one.most))
            minimised.SetParameterUpperBound(x.data(), at, one.most / one.plausible);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = most_steps;
    options.function_tolerance = 1e-7;
    options.parameter_tolerance = 1e-7;
    options.logging_type = ceres::SILENT;
    options.minimizer_progress_to_stdout = false;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &minimised, &summary);
    if (summary.termination_type == ceres::FAILURE) {
        throw InputError(
            "no rig fits: the search came to one that makes no light; allowed: poses that are the "
            "images', or a rig nearer to them");
    }
    problem.state = problem.at(x.data());
    return static_cast<int>(summary.iterations.size()) - 1;
}

void start_effects(FitBench& bench, const FitProblem& problem, const EffectVariances& most) {
    const auto [light, shares] = lit_by(bench, problem);
    bench.equations.start_effects(problem.state, light, shares, most);
}

}  // namespace

void silence_fit_log() {
    FLAGS_minloglevel = google::GLOG_FATAL;
}

FitBench::FitBench(const RigText& text, const FitSamples& samples, int threads)
    : rig(text),
      light(text.rig(), samples.places),
      equations(light, samples, threads),
      sleds(sleds_of(samples)),
      paths(light.paths(sleds)),
      learns_effects(samples.images.size() >= kFewestToLearn) {
    if (paths.longest_m <= 0.0) throw InputError("no image sees the floor");
}

LitAnswer lit_by(const FitBench& bench, const FitProblem& problem) {
    PathLight light = bench.path_light(problem.state, false);
    VectorXd shares = shares_of(bench.equations.parts(problem.state, light)).shares;
    if (!(shares.maxCoeff() > 0.0)) {
        throw InputError(
            "no rig fits: no light at all explains the images best; allowed: another --beam, or a "
            "rig "
            "nearer to the images");
    }
    return {std::move(light), std::move(shares)};
}

Linearised linearised_at(const FitBench& bench, const FitProblem& problem) {
    PathLight light = bench.path_light(problem.state, true);
    VectorXd shares = shares_of(bench.equations.parts(problem.state, light)).shares;
    FitEquations::Normal normal =
        bench.equations.normal(problem.state, light, shares, problem.numbers(), true);
    return {std::move(light), std::move(shares), std::move(normal)};
}

double objective(const FitBench& bench, const FitProblem& problem) {
    const auto parts = bench.equations.parts(problem.state, bench.path_light(problem.state, false));
    return shares_of(parts).squares + (problem.now() - problem.start()).squaredNorm();
}

void start_gains(const FitBench& bench, FitProblem& problem) {
    const auto gains = bench.equations.gains(problem.state, bench.path_light(problem.state, false));
    for (FreeNumber& one : problem.free) {
        if (one.number.part != FitPart::Gain) continue;
        one.start = gains[one.number.of];
        number_in(problem.state, one.number) = one.start;
    }
}

void learn(FitBench& bench, const FitProblem& problem, Robust robust) {
    const auto [light, shares] = lit_by(bench, problem);
    bench.equations.tie_parts(problem.state, shares);
    bench.equations.learn_noise(problem.state, light, shares, robust, bench.learns_effects);
}

void learn_to_compare(FitBench& bench, const FitProblem& answer) {
    learn(bench, answer, Robust::Huber);
    bench.equations.untie();
}

double excess(const FitBench& bench,
              const FitProblem& answer,
              const FitBench& other_bench,
              const FitProblem& other) {
    double sum = 0.0;
    for (const FitBench* by : {&bench, &other_bench})
        sum += objective(*by, answer) - objective(*by, other);
    return sum / 2.0;
}

EffectVariances first_effects(const FitOptions& options, bool are_maps) {
    constexpr double kLevel = 0.05;  // of floors
    constexpr double kHue = 0.02;
    const double altitude = options.altitude_error_m * options.altitude_error_m;
    const double attitude = options.attitude_error_rad * options.attitude_error_rad;
    const bool is_exact = altitude + attitude == 0.0 && are_maps;
    EffectVariances effects{};
    effects.fill(is_exact ? 0.0 : kLevel * kLevel);
    effects[1] = effects[2] = is_exact ? 0.0 : kHue * kHue;
    effects[kPoseEffect] = altitude;
    effects[kPoseEffect + 1] = effects[kPoseEffect + 2] = attitude;
    return effects;
}

int search_in_rounds(FitBench& bench,
                     FitProblem& problem,
                     const EffectVariances& first,
                     const std::function<void(double share)>& progress) {
    progress(0.0);
    bench.equations.assume_noise();
    bench.equations.tie_parts(problem.state, lit_by(bench, problem).shares);
    const int steps = search(bench, problem, kFirstSteps);
    return steps + search_on(bench, problem, first, progress);
}

int search_on(FitBench& bench,
              FitProblem& problem,
              const EffectVariances& first,
              const std::function<void(double share)>& progress) {
    constexpr double kSearches = static_cast<double>(kRobustRounds.size()) + 1.0;
    start_effects(bench, problem, first);
    int steps = 0;
    for (std::size_t round = 0; round < kRobustRounds.size(); ++round) {
        progress(static_cast<double>(round + 1) / kSearches);
        learn(bench, problem, kRobustRounds[round]);
        steps += search(bench, problem, kRoundSteps);
    }
    return steps;
}

}  // namespace aphotic
