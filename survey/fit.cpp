// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit.h"

#include "base/error.h"
#include "base/non_negative_fit.h"
#include "base/words.h"
#include "survey/fit_check.h"
#include "survey/fit_jackknife.h"
#include "survey/random_draw.h"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glog/logging.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

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
    bool learns_effects = false;  // their variances

    [[nodiscard]] PathLight path_light(const FitState& state, bool has_derivatives) const {
        return {rig, state.water, state.floor, paths, has_derivatives};
    }
    [[nodiscard]] Bench with(FitEquations& others) const {
        return {rig, light, others, paths, learns_effects};
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

VectorXd shares_at(const Bench& bench, const FitState& state) {
    return shares_of(bench.equations.parts(state, bench.path_light(state, false))).shares;
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
    Reduced(const Bench& bench, const FitProblem& problem) : bench_(bench), problem_(problem) {
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

    const Bench& bench_;
    const FitProblem& problem_;
    mutable VectorXd last_x_;
    mutable Solved last_;
};

// Moves the problem's state to the least of the objective. Steps that it took.
int search(const Bench& bench, FitProblem& problem, int most_steps) {
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
    if (summary.termination_type == ceres::FAILURE) {
        throw InputError(
            "no rig fits: the search came to one that makes no light; allowed: poses that are the "
            "images', or a rig nearer to them");
    }
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

// An answer's light, and what of it each part has.
struct LitAnswer {
    PathLight light;
    VectorXd shares;
};

LitAnswer lit_by(const Bench& bench, const FitProblem& problem) {
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

// Ties, noise and poses as this answer leaves them.
void learn(const Bench& bench, const FitProblem& problem, Robust robust) {
    const auto [light, shares] = lit_by(bench, problem);
    bench.equations.tie_parts(problem.state, shares);
    bench.equations.learn_noise(problem.state, light, shares, robust, bench.learns_effects);
}

void start_effects(const Bench& bench, const FitProblem& problem, const EffectVariances& most) {
    const auto [light, shares] = lit_by(bench, problem);
    bench.equations.start_effects(problem.state, light, shares, most);
}

// What looks wrong by the light of the rig, before minutes go into it.
void look_before(const Bench& bench,
                 const FitProblem& problem,
                 const FitSamples& samples,
                 const RunWatch& watch,
                 std::vector<Suspicion>& found) {
    const auto [light, shares] = lit_by(bench, problem);
    const auto mistake = mistaken_input(samples, bench.light, problem.state, light, shares);
    if (!mistake) return;
    watch.looks_wrong({*mistake});
    found.push_back(*mistake);
}

// The share of the work that is done after so many of kRobustRounds and the search before them.
double share_after(std::size_t searches) {
    return static_cast<double>(searches) / static_cast<double>(kRobustRounds.size() + 1);
}

// What is learned and the search that follows, kRobustRounds. Steps that it took.
int search_in_rounds(const Bench& bench,
                     FitProblem& problem,
                     const std::function<void(std::size_t round)>& progress) {
    constexpr int kSteps = 12;
    int steps = 0;
    for (std::size_t round = 0; round < kRobustRounds.size(); ++round) {
        progress(round);
        learn(bench, problem, kRobustRounds[round]);
        steps += search(bench, problem, kSteps);
    }
    return steps;
}

constexpr std::size_t kFewGroups = 10;

// Of a variance by kJackknifeGroups: by chance it is so many times the true one or more in a
// twentieth of all cases; and Student's t over the normal's, squared.
constexpr double kBeyondChance = 1.8;
constexpr double kStudent2 = 1.25;

// The covariance, with the jackknife's variances where these are larger by more than chance.
void widen(const VectorXd& jackknife, MatrixXd& covariance) {
    VectorXd factor = VectorXd::Ones(jackknife.size());
    for (Index k = 0; k < jackknife.size(); ++k) {
        const double own = covariance(k, k);
        if (own > 0.0 && jackknife(k) > kBeyondChance * own)
            factor(k) = std::sqrt(kStudent2 * jackknife(k) / own);
    }
    covariance = factor.asDiagonal() * covariance * factor.asDiagonal();
}

std::vector<Sled> sleds_of(const FitSamples& samples) {
    std::vector<Sled> sleds;
    for (const FitImage& image : samples.images) sleds.push_back(image.sled);
    return sleds;
}

// The beam scaled to a flux of 1, by its flux as fitted: where nobody looks that is told badly, and
// the shape elsewhere is none the worse for it. Errors are those of the shares and the exponent.
std::vector<BeamPoint> curve_of(const FitBeam& beam,
                                const VectorXd& shares,
                                const MatrixXd& covariance) {
    constexpr int kPoints = 91;
    const double flux = beam.beam_of(shares).flux;
    std::vector<BeamPoint> points;
    for (int i = 0; i < kPoints; ++i) {
        const double theta_rad = std::min(beam.widest_rad(), beam.widest_rad() * i / (kPoints - 1));
        const VectorXd f = beam.parts_at(theta_rad);
        VectorXd slopes(covariance.rows());
        slopes.head(shares.size()) = f / flux;
        for (std::size_t k = 0; k < beam.shapes().size(); ++k)
            slopes(shares.size() + static_cast<Index>(k)) =
                beam.slopes_at(theta_rad).at(k) * shares(0) / flux;
        points.push_back({.theta_rad = theta_rad,
                          .intensity = f.dot(shares) / flux,
                          .error = std::sqrt(std::max(0.0, slopes.dot(covariance * slopes)))});
    }
    return points;
}

// Where the beam's shares and shapes stand in the covariance.
std::vector<Index> rows_of_beam(const FitResult& result, std::size_t beam) {
    Index first = 0;
    for (std::size_t b = 0; b < beam; ++b)
        first += static_cast<Index>(result.state.beams[b].parts());
    std::vector<Index> rows;
    for (std::size_t k = 0; k < result.state.beams[beam].parts(); ++k)
        rows.push_back(first + static_cast<Index>(k));
    for (std::size_t k = 0; k < result.numbers.size(); ++k) {
        const FitNumber& number = result.numbers[k].number;
        if (number.part == FitPart::BeamShape && number.of == beam)
            rows.push_back(result.shares.size() + static_cast<Index>(k));
    }
    return rows;
}

double objective(const Bench& bench, const FitProblem& problem) {
    const auto parts = bench.equations.parts(problem.state, bench.path_light(problem.state, false));
    return shares_of(parts).squares + (problem.now() - problem.start()).squaredNorm();
}

constexpr int kFirstSteps = 25;

// Of one answer's objective over another's, by the noise as the other leaves it and Huber's
// weights: Tukey's take what speaks against the answer that they come from for stones.
double excess_of(const FitProblem& one, const Bench& bench, const FitProblem& other) {
    FitEquations equations = bench.equations;
    const Bench own = bench.with(equations);
    learn(own, other, Robust::Huber);
    return objective(own, one) - objective(own, other);
}

// The search once more from the rig, by the noise that is known now: the first steps of the first
// knew none, and on a rough floor two answers may explain the images all but alike. The better by
// the noise of both stays.
void search_again(const Bench& bench, FitProblem& problem, const RunWatch& watch, int& steps) {
    FitEquations equations = bench.equations;
    const Bench own = bench.with(equations);
    FitProblem again = problem;
    learn(own, problem, Robust::Huber);
    again.state = problem.at(problem.start().data());
    steps += search(own, again, kFirstSteps);
    steps += search_in_rounds(own, again, [&](std::size_t round) {
        watch.progress("fitting again", share_after(round + 1));
    });
    const double excess = 0.5 * (excess_of(again, bench, problem) - excess_of(problem, own, again));
    if (excess < 0.0) {
        std::swap(problem, again);
        std::swap(bench.equations, equations);
    }
}

// An answer's light, shares and normal equations.
struct Linearised {
    PathLight light;
    VectorXd shares;
    FitEquations::Normal normal;
};

Linearised linearised_at(const Bench& bench, const FitProblem& problem) {
    PathLight light = bench.path_light(problem.state, true);
    VectorXd shares = shares_of(bench.equations.parts(problem.state, light)).shares;
    FitEquations::Normal normal =
        bench.equations.normal(problem.state, light, shares, problem.numbers(), true);
    return {std::move(light), std::move(shares), std::move(normal)};
}

// How much larger the variances of the numbers are than noise alone would have them.
double dispersion_of(const MatrixXd& covariance, const Linearised& at, const FitProblem& problem) {
    const MatrixXd S = scaled_hessian(at.normal, at.shares, problem);
    const VectorXd own = S.llt().solve(MatrixXd::Identity(S.rows(), S.cols())).diagonal();
    const VectorXd told =
        covariance.diagonal().tail(own.size()).cwiseQuotient(problem.plausible().cwiseAbs2());
    return std::max(1.0, told.cwiseQuotient(own).mean());
}

// Where a search may begin as well: at the rig, then off it by half of what is plausible, at
// random.
std::vector<VectorXd> starts_of(const FitProblem& problem) {
    constexpr std::size_t kStarts = 8;
    constexpr double kOff = 0.5;
    RandomSource random = random_of(1, 0);
    std::vector<VectorXd> starts(kStarts, problem.start());
    for (std::size_t i = 1; i < kStarts; ++i) {
        for (Index k = 0; k < starts[i].size(); ++k) {
            const FreeNumber& one = problem.free[static_cast<std::size_t>(k)];
            if (one.number.part == FitPart::Gain) continue;  // as start_gains has them
            starts[i](k) = std::clamp(starts[i](k) + kOff * normal(random),
                                      one.least / one.plausible,
                                      one.most / one.plausible);
        }
    }
    return starts;
}

// What searches from elsewhere find, the answer's own first. By coarse blocks, unless beams have
// edges, and by the noise that the answer leaves, with Huber's weights: Tukey's take what speaks
// against the answer that they come from for stones.
std::vector<Rival> rivals_of(const Bench& answer,
                             const FitProblem& problem,
                             const FitSamples& samples,
                             int threads,
                             const RunWatch& watch) {
    constexpr int kBlocksAcross = 20;
    const bool has_edges =
        std::ranges::count(problem.state.beams, FitBeamKind::Cones, &FitBeam::kind) > 0;
    const FitSamples coarse = has_edges ? samples : in_blocks(samples, kBlocksAcross);
    const FitLight light(answer.rig.rig(), coarse.places);
    FitEquations equations(light, coarse, threads);
    const Bench bench{.rig = answer.rig,
                      .light = light,
                      .equations = equations,
                      .paths = light.paths(sleds_of(coarse)),
                      .learns_effects = answer.learns_effects};
    equations.assume_noise();
    equations.set_effects(answer.equations.effects());
    for (const Robust robust : kRobustRounds) learn(bench, problem, robust);
    learn(bench, problem, Robust::Huber);
    const Linearised at = linearised_at(bench, problem);
    const double dispersion =
        dispersion_of(covariance_of(at.normal, at.shares, problem.free), at, problem);

    std::vector<Rival> rivals;
    const auto search_from = [&](const FitState& start) {
        FitProblem found = problem;
        found.state = start;
        search(bench, found, kFirstSteps);
        rivals.push_back({.values = values_of(shares_at(bench, found.state), found),
                          .excess = objective(bench, found) / dispersion});
    };
    search_from(problem.state);
    const std::vector<VectorXd> starts = starts_of(problem);
    for (const VectorXd& start : starts) {
        watch.progress("fitting from elsewhere",
                       static_cast<double>(rivals.size()) / static_cast<double>(starts.size() + 1));
        search_from(problem.at(start.data()));
    }
    const double least = rivals.front().excess;
    for (Rival& rival : rivals) rival.excess -= least;
    return rivals;
}

// Rivals as good as the answer are as likely, and the errors allow for that. Where one is
// elsewhere, a doubt names the number in which it differs most.
void look_at_rivals(const std::vector<Rival>& rivals,
                    const FitProblem& problem,
                    FitResult& result) {
    constexpr double kElsewhere = 2.0;
    const VectorXd errors = result.covariance.diagonal().cwiseSqrt();
    const auto count = static_cast<Index>(problem.free.size());
    VectorXd squares = VectorXd::Zero(errors.size());
    double all = 0.0;
    double most = kElsewhere;
    std::optional<Suspicion> doubt;
    // To an error of each number.
    const auto is_new = [&](const Rival& rival) {
        return std::ranges::none_of(result.rivals, [&](const Rival& other) {
            const VectorXd apart = (rival.values - other.values).tail(count).cwiseAbs();
            return (apart.array() < errors.tail(count).array()).all();
        });
    };
    for (const Rival& rival : rivals) {
        if (rival.excess > kAsGood) continue;
        const VectorXd off = rival.values - rivals.front().values;
        squares += off.cwiseAbs2();
        all += 1.0;

        Index worst = 0;
        const double in_errors =
            off.tail(count).cwiseAbs().cwiseQuotient(errors.tail(count)).maxCoeff(&worst);
        if (in_errors > kElsewhere && is_new(rival)) result.rivals.push_back(rival);
        if (in_errors <= most) continue;
        most = in_errors;
        const FreeNumber& number = problem.free[static_cast<std::size_t>(worst)];
        doubt = {"rival",
                 fmt::format("another rig explains the images {}; its {} is {:.4g}",
                             rival.excess < -kAsGood ? "better" : "as well",
                             number.key,
                             number.per_unit * rival.values(errors.size() - count + worst))};
    }
    if (doubt) result.looks_wrong.push_back(*doubt);
    VectorXd wider = VectorXd::Ones(errors.size());
    for (Index k = 0; k < errors.size(); ++k)
        if (errors(k) > 0.0) wider(k) = std::hypot(1.0, std::sqrt(squares(k) / all) / errors(k));
    result.covariance = wider.asDiagonal() * result.covariance * wider.asDiagonal();
}

// Those that are held may be off as far as is plausible, and all others with them.
MatrixXd covariance_with(const std::vector<FreeNumber>& held,
                         const Bench& bench,
                         const FitProblem& problem,
                         const Linearised& at) {
    if (held.empty()) return covariance_of(at.normal, at.shares, problem.free);
    FitProblem all = problem;
    all.free.insert(all.free.end(), held.begin(), held.end());
    const FitEquations::Normal normal =
        bench.equations.normal(problem.state, at.light, at.shares, all.numbers(), true);
    const Index told = at.shares.size() + std::ssize(problem.free);
    return covariance_of(normal, at.shares, all.free).topLeftCorner(told, told);
}

FitResult result_of(const Bench& bench,
                    const FitProblem& problem,
                    const std::vector<FreeNumber>& held,
                    const FitSamples& samples,
                    const std::vector<Rival>& rivals,
                    const RunWatch& watch) {
    const Linearised at = linearised_at(bench, problem);
    FitResult result;
    result.state = problem.state;
    result.shares = at.shares;
    result.covariance = covariance_with(held, bench, problem, at);
    result.effects = bench.equations.effects();
    result.noise = bench.equations.noise();
    result.blocks = bench.equations.blocks();
    result.tiles = at.normal.tiles;
    result.left = fit_residuals(bench.equations, samples, result.state, at.light, result.shares);
    result.are_maps = samples.are_maps;
    result.block_px = samples.places.block_px;
    if (!samples.are_maps && samples.images.size() >= kFewGroups) {
        const std::size_t groups = std::min(kJackknifeGroups, samples.images.size());
        const auto light_of = [&](const FitState& state) { return bench.path_light(state, true); };
        widen(jackknife(bench.equations, problem, light_of, at.shares, groups, watch),
              result.covariance);
    }
    if (!rivals.empty()) look_at_rivals(rivals, problem, result);
    const Index parts = result.shares.size();
    for (std::size_t k = 0; k < problem.free.size(); ++k) {
        const FreeNumber& one = problem.free[k];
        const Index at_number = parts + static_cast<Index>(k);
        const double value = number_in(result.state, one.number);
        result.numbers.push_back(
            {.number = one.number,
             .key = one.key,
             .start = one.start * one.per_unit,
             .value = value * one.per_unit,
             .error = one.per_unit * std::sqrt(result.covariance(at_number, at_number)),
             .plausible = one.per_unit * one.plausible,
             .per_unit = one.per_unit,
             .is_at_bound = value <= one.least || value >= one.most});
    }
    result.confounded = confounded_in(result.covariance, parts, problem.free);
    for (std::size_t b = 0; b < result.state.beams.size(); ++b) {
        const FitBeam& beam = result.state.beams[b];
        if (!beam.is_round()) continue;
        const std::vector<Index> rows = rows_of_beam(result, b);
        const auto count = static_cast<Index>(beam.parts());
        result.beam_curves.push_back(curve_of(
            beam, result.shares.segment(rows.front(), count), result.covariance(rows, rows)));
    }
    return result;
}

// Variances of what images share, at first.
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

// Held at the rig's, or where they were asked for, refused.
void hold(const std::vector<NotTold>& untold,
          const FitOptions& options,
          FitProblem& problem,
          std::vector<FreeNumber>& held) {
    if (options.free) {
        std::vector<std::string> words;
        for (const NotTold& one : untold) words.push_back(words_of(one));
        throw InputError("--free: {}", fmt::join(words, "; "));
    }
    for (const NotTold& one : untold) {
        const auto at = std::ranges::find(problem.free, one.key, &FreeNumber::key);
        number_in(problem.state, at->number) = at->start;
        held.push_back(*at);
        problem.free.erase(at);
    }
}

}  // namespace

void require_bare_floor(const Rig& rig) {
    if (!rig.objects.empty()) {
        throw InputError("found {}; allowed: none, for a survey shows the bare floor on average",
                         counted(rig.objects.size(), "object"));
    }
    if (!rig.scene.empty())
        throw InputError(
            "scene: found {}; allowed: none, for a survey shows the bare floor on average",
            rig.scene.string());
    if (rig.seafloor.phong > 0.0)
        throw InputError("seafloor.phong: found {}; allowed: 0, for a fit's floor is matt",
                         rig.seafloor.phong);
}

FitResult fit(const RigText& text,
              const FitSamples& samples,
              const FitOptions& options,
              const RunWatch& watch) {
    const Rig rig = text.rig();
    require_bare_floor(rig);
    const FitLight light(rig, samples.places);
    const std::vector<Sled> sleds = sleds_of(samples);
    const PathRange paths = light.paths(sleds);
    if (paths.longest_m <= 0.0) throw InputError("no image sees the floor");
    FitEquations equations(light, samples, options.threads);
    FitProblem problem = fit_problem(
        text, options, {.widest_rad = light.widest_rad(sleds), .block_rad = light.block_rad()});
    // That tell the variances of what they share: held at first_effects', these leave to the finest
    // detail all that an even floor tells.
    constexpr std::size_t kFewestToLearn = 5;
    const Bench bench{.rig = text,
                      .light = light,
                      .equations = equations,
                      .paths = paths,
                      .learns_effects = samples.images.size() >= kFewestToLearn};
    const EffectVariances effects = first_effects(options, samples.are_maps);
    std::vector<std::string> fixed = words_fixed_in(problem);
    std::vector<Suspicion> doubts = samples.looks_wrong;
    std::vector<NotTold> all_untold;
    std::vector<FreeNumber> held;
    int steps = 0;
    for (bool is_first = true;; is_first = false) {
        const auto progress = [&](std::size_t round) {
            watch.progress("fitting", share_after(round));
        };
        progress(0);
        equations.assume_noise();
        if (is_first) {
            start_gains(bench, problem);
            look_before(bench, problem, samples, watch, doubts);
        }
        equations.tie_parts(problem.state, lit_by(bench, problem).shares);
        steps += search(bench, problem, kFirstSteps);
        start_effects(bench, problem, effects);
        steps += search_in_rounds(bench, problem, [&](std::size_t round) { progress(round + 1); });
        const Linearised at = linearised_at(bench, problem);
        const std::vector<NotTold> untold =
            not_told(equations, problem, at.light, at.normal.H, at.shares, sleds);
        if (untold.empty()) break;
        hold(untold, options, problem, held);
        all_untold.insert(all_untold.end(), untold.begin(), untold.end());
    }
    std::vector<Rival> rivals;
    if (!samples.are_maps && samples.images.size() >= kFewGroups) {
        search_again(bench, problem, watch, steps);
        if (!problem.free.empty())
            rivals = rivals_of(bench, problem, samples, options.threads, watch);
    }
    FitResult result = result_of(bench, problem, held, samples, rivals, watch);
    watch.progress("fitting", 1.0);
    result.held = std::move(all_untold);
    for (const Suspicion& one : suspicions(samples, result)) doubts.push_back(one);
    result.looks_wrong.insert(result.looks_wrong.begin(), doubts.begin(), doubts.end());
    result.fixed = std::move(fixed);
    result.rounds = static_cast<int>(kRobustRounds.size()) + 1;
    result.steps = steps;
    return result;
}

}  // namespace aphotic
