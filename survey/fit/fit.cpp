// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit.h"

#include "base/error.h"
#include "base/words.h"
#include "survey/fit/fit_check.h"
#include "survey/fit/fit_halves.h"
#include "survey/fit/fit_parts.h"
#include "survey/fit/fit_search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Fewer images cannot be halved, nor tell how many parts a beam has.
constexpr std::size_t kFewImages = 10;

// What looks wrong by the light of the rig, before minutes go into it.
void look_before(const FitBench& bench,
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

// In blocks as coarse as tell the same, unless beams have edges.
FitSamples coarse_of(const FitSamples& samples, const FitState& state) {
    constexpr int kBlocksAcross = 20;
    const bool has_edges = std::ranges::count(state.beams, FitBeamKind::Cones, &FitBeam::kind) > 0;
    return has_edges ? samples : in_blocks(samples, kBlocksAcross);
}

// A search on some of the images: from the rig, or on from an answer.
struct HalfSearch {
    HalfSearch(const RigText& text,
               const FitSamples& samples,
               const FitOptions& options,
               const FitProblem& answer,
               bool is_from_rig)
        : bench(text, samples, options.threads), problem(answer) {
        const EffectVariances first = first_effects(options, samples.are_maps);
        const auto silently = [](double) {};
        if (is_from_rig) {
            problem.state = answer.at(answer.start().data());
            search_in_rounds(bench, problem, first, silently);
        } else {
            bench.equations.assume_noise();
            search_on(bench, problem, first, silently);
        }
        values = values_of(lit_by(bench, problem).shares, problem);
    }
    FitBench bench;
    FitProblem problem;
    VectorXd values;
};

// What a half of the images gives, from the rig. Where that is far from the answer to all, beyond
// kFar of its errors, the search may have ended in a valley that the half itself surely does not
// prefer: then it is what comes of the answer. Sure is four standard deviations, for S is a square.
// Less may be texture's doing: to twenty images of a rough floor an answer whose aim was 3.4
// degrees off was 14 better than another.
VectorXd values_of_half(std::size_t half,
                        const RigText& text,
                        const FitSamples& samples,
                        const FitOptions& options,
                        const FitProblem& answer,
                        const VectorXd& errors) {
    constexpr double kFar = 3.0;
    constexpr double kSurely = 16.0;
    FitSamples some = samples;
    some.images.clear();
    for (std::size_t i = 0; i < samples.images.size(); ++i)
        if (is_in_half(i, half)) some.images.push_back(samples.images[i]);
    HalfSearch by_rig(text, some, options, answer, true);
    const VectorXd off =
        (by_rig.problem.now() - answer.now()).cwiseProduct(answer.plausible()).cwiseAbs();
    if ((off.array() < kFar * errors.array()).all()) return by_rig.values;
    HalfSearch by_answer(text, some, options, answer, false);
    learn_to_compare(by_rig.bench, by_rig.problem);
    learn_to_compare(by_answer.bench, by_answer.problem);
    const double excess_of_rig =
        excess(by_rig.bench, by_rig.problem, by_answer.bench, by_answer.problem);
    return excess_of_rig > kSurely ? by_answer.values : by_rig.values;
}

// Of a variance by kHalves: by chance it is so many times the true one or more in a twentieth of
// all cases; and Student's t over the normal's, squared.
constexpr double kBeyondChance = 1.67;
constexpr double kStudent2 = 1.18;

// The covariance, with the halves' variances where these are larger by more than chance.
void widen(const VectorXd& by_halves, MatrixXd& covariance) {
    VectorXd factor = VectorXd::Ones(by_halves.size());
    for (Index k = 0; k < by_halves.size(); ++k) {
        const double own = covariance(k, k);
        if (own > 0.0 && by_halves(k) > kBeyondChance * own)
            factor(k) = std::sqrt(kStudent2 * by_halves(k) / own);
    }
    covariance = factor.asDiagonal() * covariance * factor.asDiagonal();
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

// Those that are held may be off as far as is plausible, and all others with them.
MatrixXd covariance_with(const std::vector<FreeNumber>& held,
                         const FitBench& bench,
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

FitResult result_of(const FitBench& bench,
                    const FitProblem& problem,
                    const FitSamples& samples,
                    const Linearised& at,
                    const MatrixXd& covariance) {
    FitResult result;
    result.state = problem.state;
    result.shares = at.shares;
    result.covariance = covariance;
    result.effects = bench.equations.effects();
    result.noise = bench.equations.noise();
    result.blocks = bench.equations.blocks();
    result.tiles = at.normal.tiles;
    result.left = fit_residuals(bench.equations, samples, result.state, at.light, result.shares);
    result.are_maps = samples.are_maps;
    result.block_px = samples.places.block_px;
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
    require_bare_floor(text.rig());
    FitBench bench(text, samples, options.threads);
    const FitAngles angles{.widest_rad = bench.light.widest_rad(bench.sleds),
                           .block_rad = bench.light.block_rad()};
    FitProblem problem = fit_problem(text, options, angles);
    std::vector<std::string> fixed = words_fixed_in(problem);
    std::vector<Suspicion> doubts = samples.looks_wrong;
    watch.progress("fitting", 0.0);
    bench.equations.assume_noise();
    start_gains(bench, problem);
    look_before(bench, problem, samples, watch, doubts);

    const bool has_many = !samples.are_maps && samples.images.size() >= kFewImages;
    const FitSamples coarse = has_many ? coarse_of(samples, problem.state) : FitSamples{};
    const bool has_table =
        std::ranges::count(problem.state.beams, FitBeamKind::Table, &FitBeam::kind) > 0;
    if (has_many && has_table && !options.parts)
        problem = with_told_parts(text, coarse, options, angles, watch);

    const EffectVariances effects = first_effects(options, samples.are_maps);
    std::vector<NotTold> all_untold;
    std::vector<FreeNumber> held;
    int steps = 0;
    for (;;) {
        steps += search_in_rounds(
            bench, problem, effects, [&](double share) { watch.progress("fitting", share); });
        const Linearised at = linearised_at(bench, problem);
        const std::vector<NotTold> untold =
            not_told(bench.equations, problem, at.light, at.normal.H, at.shares, bench.sleds);
        if (untold.empty()) break;
        hold(untold, options, problem, held);
        all_untold.insert(all_untold.end(), untold.begin(), untold.end());
    }
    const Linearised at = linearised_at(bench, problem);
    MatrixXd covariance = covariance_with(held, bench, problem, at);
    if (has_many) {
        const VectorXd errors =
            covariance.diagonal().tail(std::ssize(problem.free)).cwiseMax(0.0).cwiseSqrt();
        const VectorXd by_halves = variances_by_halves([&](std::size_t half) {
            watch.progress("fitting halves",
                           static_cast<double>(half) / static_cast<double>(kHalves + 1));
            return values_of_half(half, text, coarse, options, problem, errors);
        });
        widen(by_halves, covariance);
    }
    FitResult result = result_of(bench, problem, samples, at, covariance);
    watch.progress("fitting", 1.0);
    result.held = std::move(all_untold);
    for (const Suspicion& one : suspicions(samples, result)) doubts.push_back(one);
    result.looks_wrong.insert(result.looks_wrong.begin(), doubts.begin(), doubts.end());
    result.fixed = std::move(fixed);
    result.rounds = static_cast<int>(kRobustRounds.size()) + 1;
    result.steps = steps;
    return result;
}

std::string words_of(const FitResult& result) {
    const FitBeam& beam = result.state.beams.front();
    return fmt::format("{}{} fitted to {}",
                       counted(result.numbers.size(), "number"),
                       beam.kind() == FitBeamKind::Table
                           ? fmt::format(" and a beam of {} splines", beam.parts())
                           : "",
                       counted(result.left.images.size(), result.are_maps ? "map" : "image"));
}

}  // namespace aphotic
