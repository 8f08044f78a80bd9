// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit.h"

#include "base/error.h"
#include "base/non_negative_fit.h"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glog/logging.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Everything that an evaluation needs.
struct Bench {
    const RigText& rig;
    const FitLight& light;
    FitEquations& equations;
    PathRange paths;

    [[nodiscard]] PathLight path_light(const FitState& state, bool has_derivatives) const {
        return {rig, state.water, state.floor, paths, has_derivatives};
    }
};

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

// The objective for Ceres, in n + 1 residuals that have its value, gradient and Gauss-Newton
// matrix: all that its trust region asks for. So a million blocks come as some twenty rows.
class Reduced : public ceres::CostFunction {
  public:
    Reduced(const Bench& bench, const FitProblem& problem) : bench_(bench), problem_(problem) {
        const auto count = static_cast<int>(problem.free.size());
        mutable_parameter_block_sizes()->push_back(count);
        set_num_residuals(count + 1);
    }

    bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
        const bool has_slopes = jacobians != nullptr && jacobians[0] != nullptr;
        const FitState state = problem_.at(x[0]);
        const auto count = static_cast<Index>(problem_.free.size());
        const PathLight light = bench_.path_light(state, has_slopes);
        const Solved& solved = solved_at(VectorXd::Map(x[0], count), state, light);
        VectorXd off(count);  // from where it began
        double squares = solved.squares;
        for (Index k = 0; k < count; ++k) {
            const FreeNumber& one = problem_.free[static_cast<std::size_t>(k)];
            off(k) = x[0][k] - one.start / one.plausible;
            squares += off(k) * off(k);
        }
        if (!std::isfinite(squares)) return false;
        Eigen::Map<VectorXd> r(residuals, count + 1);
        r.setZero();
        r(count) = std::sqrt(squares);
        if (!has_slopes) return true;
        const FitEquations::Normal normal =
            bench_.equations.normal(state, light, solved.shares, problem_.numbers(), false);
        const Index parts = solved.shares.size();
        VectorXd scale(count);
        for (Index k = 0; k < count; ++k)
            scale(k) = problem_.free[static_cast<std::size_t>(k)].plausible;
        MatrixXd S =
            scale.asDiagonal() *
            eliminated(normal.H, active_parts(solved.shares), numbers_after(parts, count)) *
            scale.asDiagonal();
        S.diagonal().array() += 1.0;
        const VectorXd gradient = off - scale.cwiseProduct(normal.gradient.tail(count));
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

    const Bench& bench_;
    const FitProblem& problem_;
    mutable VectorXd last_x_;
    mutable Solved last_;
};

// Moves the problem's state to the least of the objective. Steps that it took.
int search(const Bench& bench, FitProblem& problem, int most_steps) {
    if (problem.free.empty()) return 0;
    std::vector<double> x;
    for (const FreeNumber& one : problem.free)
        x.push_back(number_in(problem.state, one.number) / one.plausible);
    ceres::Problem minimised;
    minimised.AddResidualBlock(new Reduced(bench, problem), nullptr, x.data());
    for (std::size_t k = 0; k < x.size(); ++k) {
        const FreeNumber& one = problem.free[k];
        const auto at = static_cast<int>(k);
        if (std::isfinite(one.least))
            minimised.SetParameterLowerBound(x.data(), at, one.least / one.plausible);
        if (std::isfinite(one.most))
            minimised.SetParameterUpperBound(x.data(), at, one.most / one.plausible);
    }
    FLAGS_minloglevel = google::GLOG_FATAL;  // what it has to say is in the summary
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = most_steps;
    options.function_tolerance = 1e-7;
    options.parameter_tolerance = 1e-7;
    options.logging_type = ceres::SILENT;
    options.minimizer_progress_to_stdout = false;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &minimised, &summary);
    if (summary.termination_type == ceres::FAILURE)
        throw InputError("no rig fits: {}", summary.message);
    problem.state = problem.at(x.data());
    return static_cast<int>(summary.iterations.size()) - 1;
}

// Gains that bring each channel's light to the images': the search begins there, for a camera's
// gains may be anything.
void start_gains(const Bench& bench, FitProblem& problem) {
    const auto gains = bench.equations.gains(problem.state, bench.path_light(problem.state, false));
    for (FreeNumber& one : problem.free) {
        if (one.number.part != FitPart::Gain) continue;
        one.start = gains[one.number.of];
        number_in(problem.state, one.number) = one.start;
    }
}

constexpr std::size_t kGroups = 12;  // of images, each left out once
constexpr std::size_t kFewGroups = 10;

// Variances of shares and numbers by the jackknife: what they move by as each group of images is
// left out in turn. It knows no model of the noise, nor that the light is anything like a straight
// line.
VectorXd jackknife(const Bench& bench, const FitProblem& problem, std::size_t groups) {
    std::vector<VectorXd> found;
    for (std::size_t group = 0; group < groups; ++group) {
        bench.equations.leave_out(group, groups);
        FitProblem without = problem;
        constexpr int kMostSteps = 12;
        search(bench, without, kMostSteps);
        const VectorXd shares =
            shares_of(bench.equations.parts(without.state, bench.path_light(without.state, false)))
                .shares;
        VectorXd all(shares.size() + static_cast<Index>(without.free.size()));
        all.head(shares.size()) = shares;
        for (std::size_t k = 0; k < without.free.size(); ++k) {
            all(shares.size() + static_cast<Index>(k)) =
                number_in(without.state, without.free[k].number);
        }
        found.push_back(std::move(all));
    }
    bench.equations.leave_out(0, 0);
    VectorXd mean = VectorXd::Zero(found.front().size());
    for (const VectorXd& one : found) mean += one / static_cast<double>(groups);
    VectorXd variances = VectorXd::Zero(mean.size());
    for (const VectorXd& one : found) variances += (one - mean).cwiseAbs2();
    return variances * static_cast<double>(groups - 1) / static_cast<double>(groups);
}

// The covariance, widened to these variances where its own are smaller.
void widen(const VectorXd& variances, MatrixXd& covariance) {
    VectorXd factor = VectorXd::Ones(variances.size());
    for (Index k = 0; k < variances.size(); ++k) {
        const double own = covariance(k, k);
        if (own > 0.0) factor(k) = std::sqrt(std::max(1.0, variances(k) / own));
    }
    covariance = factor.asDiagonal() * covariance * factor.asDiagonal();
}

std::vector<Sled> sleds_of(const FitSamples& samples) {
    std::vector<Sled> sleds;
    for (const FitImage& image : samples.images) sleds.push_back(image.sled);
    return sleds;
}

std::vector<BeamPoint> curve_of(const FitBeam& beam,
                                const VectorXd& shares,
                                const MatrixXd& covariance) {
    constexpr int kPoints = 91;
    const double flux = beam.beam_of(shares).flux;
    std::vector<BeamPoint> points;
    for (int i = 0; i < kPoints; ++i) {
        const double theta_rad = beam.widest_rad() * i / (kPoints - 1);
        const VectorXd f = beam.parts_at(theta_rad);
        points.push_back({.theta_rad = theta_rad,
                          .intensity = f.dot(shares) / flux,
                          .error = std::sqrt(std::max(0.0, f.dot(covariance * f))) / flux});
    }
    return points;
}

// What cannot be told is found first: then there is no result.
FitResult result_of(const Bench& bench,
                    const FitProblem& problem,
                    const FitSamples& samples,
                    std::vector<NotTold>& untold) {
    const PathLight light = bench.path_light(problem.state, true);
    const Solved solved = shares_of(bench.equations.parts(problem.state, light));
    const FitEquations::Normal normal =
        bench.equations.normal(problem.state, light, solved.shares, problem.numbers(), true);
    untold = not_told(bench.equations, problem, light, normal.H, solved.shares, sleds_of(samples));
    FitResult result;
    if (!untold.empty()) return result;  // refused, or fitted again: no more of it is wanted
    result.state = problem.state;
    result.shares = solved.shares;
    result.covariance =
        covariance_of(normal, solved.shares, problem.free, bench.equations.weights_factor());
    result.effects = bench.equations.effects();
    result.noise = bench.equations.noise();
    result.blocks = bench.equations.blocks();
    result.tiles = normal.tiles;
    result.left = fit_residuals(bench.equations, samples, result.state, light, result.shares);
    const std::size_t groups = std::min(kGroups, samples.images.size());
    if (groups >= kFewGroups && !samples.are_maps) {
        // The biweight's weights take what another answer would explain for stones, and would hold
        // the fit to this one.
        bench.equations.learn_noise(problem.state, light, solved.shares, Robust::Huber, false);
        widen(jackknife(bench, problem, groups), result.covariance);
    }
    const Index parts = solved.shares.size();
    for (std::size_t k = 0; k < problem.free.size(); ++k) {
        const FreeNumber& one = problem.free[k];
        const Index at = parts + static_cast<Index>(k);
        const double value = number_in(result.state, one.number);
        result.numbers.push_back({.number = one.number,
                                  .key = one.key,
                                  .start = one.start * one.per_unit,
                                  .value = value * one.per_unit,
                                  .error = one.per_unit * std::sqrt(result.covariance(at, at)),
                                  .per_unit = one.per_unit,
                                  .is_at_bound = value <= one.least || value >= one.most});
    }
    result.confounded = confounded_in(result.covariance, parts, problem.free);
    Index first = 0;
    for (const FitBeam& beam : result.state.beams) {
        const auto count = static_cast<Index>(beam.parts());
        if (beam.kind() == FitBeamKind::Table || beam.kind() == FitBeamKind::Cosine) {
            result.beam_curves.push_back(
                curve_of(beam,
                         result.shares.segment(first, count),
                         result.covariance.block(first, first, count, count)));
        }
        first += count;
    }
    return result;
}

}  // namespace

FitResult fit(const RigText& text,
              const FitSamples& samples,
              const FitOptions& options,
              const RunWatch& watch) {
    const Rig rig = text.rig();
    if (!rig.objects.empty() || !rig.scene.empty())
        throw InputError(
            "found objects or a scene; allowed: the bare floor, which a survey shows on average");
    if (rig.seafloor.phong > 0.0)
        throw InputError("seafloor.phong: found {}; allowed: 0, for a fit's floor is matt",
                         rig.seafloor.phong);
    const FitLight light(rig, samples.places);
    const std::vector<Sled> sleds = sleds_of(samples);
    const PathRange paths = light.paths(sleds);
    if (paths.longest_m <= 0.0) throw InputError("no image sees the floor");
    FitEquations equations(light, samples, options.threads);
    FitProblem problem = fit_problem(text, options, light.widest_rad(sleds));
    const Bench bench{.rig = text, .light = light, .equations = equations, .paths = paths};

    EffectVariances effects{};
    constexpr double kLevel = 0.05;  // of floors, at first
    constexpr double kHue = 0.02;
    const double altitude = options.altitude_error_m * options.altitude_error_m;
    const double attitude = options.attitude_error_rad * options.attitude_error_rad;
    const bool is_exact = altitude + attitude == 0.0 && samples.are_maps;
    const double level = is_exact ? 0.0 : kLevel * kLevel;
    const double hue = is_exact ? 0.0 : kHue * kHue;
    effects.fill(level);
    effects[1] = effects[2] = hue;
    effects[kPoseEffect] = altitude;
    effects[kPoseEffect + 1] = effects[kPoseEffect + 2] = attitude;
    constexpr std::size_t kManyImages = 30;  // that tell the variances of what they share
    const bool learns_effects = samples.images.size() >= kManyImages;

    std::vector<NotTold> held;
    FitResult result;
    constexpr int kHuberRounds = 2;
    constexpr int kRounds = 5;
    int steps = 0;
    for (int attempt = 0;; ++attempt) {
        equations.assume_noise();
        if (attempt == 0) start_gains(bench, problem);
        equations.tie_parts(
            problem.state,
            shares_of(equations.parts(problem.state, bench.path_light(problem.state, false)))
                .shares);
        for (int round = 0; round <= kRounds; ++round) {
            watch.progress("fitting", static_cast<double>(round) / (kRounds + 1));
            constexpr int kFirstSteps = 25;
            constexpr int kSteps = 12;
            steps += search(bench, problem, round == 0 ? kFirstSteps : kSteps);
            if (round == kRounds) break;
            const PathLight path_light = bench.path_light(problem.state, false);
            const Solved solved = shares_of(equations.parts(problem.state, path_light));
            if (round == 0) equations.set_effects(effects);
            equations.tie_parts(problem.state, solved.shares);
            equations.learn_noise(problem.state,
                                  path_light,
                                  solved.shares,
                                  round < kHuberRounds ? Robust::Huber : Robust::Biweight,
                                  learns_effects);
        }
        std::vector<NotTold> untold;
        result = result_of(bench, problem, samples, untold);
        if (untold.empty()) break;
        if (options.free) {
            std::vector<std::string> words;
            for (const NotTold& one : untold) words.push_back(words_of(one));
            throw InputError("{}", fmt::join(words, "; "));
        }
        for (const NotTold& one : untold) {
            held.push_back(one);
            const auto at = std::ranges::find(problem.free, one.key, &FreeNumber::key);
            number_in(problem.state, at->number) = at->start;
            problem.free.erase(at);
        }
    }
    watch.progress("fitting", 1.0);
    result.held = std::move(held);
    result.rounds = kRounds + 1;
    result.steps = steps;
    return result;
}

}  // namespace aphotic
