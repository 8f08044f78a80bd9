// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/non_negative_fit.h"
#include "rig/vignetting.h"
#include "spectral/natural_water.h"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glog/logging.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A number that is free: where it begins, how far from there it may plausibly be, its bounds.
struct Free {
    FitNumber number;
    std::string key;
    double plausible = 1.0;
    double least = -kInfinity;
    double most = kInfinity;
    double per_unit = 1.0;
    std::string group;  // as it is asked for
    double start = 0.0;
};

struct WaterBounds {
    const char* key;
    double absent;  // where the rig does not tell it
    double least;
    double most;
    double plausible;  // and no less than its value
};
constexpr std::array<WaterBounds, 2> kWaterNumbers{
    {{"multiple", 1.0, 0.0, 1e3, 0.3}, {"uniform_loss_per_m", 0.0, 0.0, 1e2, 0.1}}};
// Chlorophyll: what the reader allows, and room for differences.
constexpr std::array<WaterBounds, 3> kCase1Numbers{{{"chlorophyll_mg_m3", 1.0, 0.0202, 29.8, 0.3},
                                                    {"cdom_440_per_m", 0.0, 0.0, 1e2, 0.05},
                                                    {"particles", 1.0, 0.0, 1e2, 0.3}}};

// What is asked for by one word each.
constexpr std::array kWords{
    "beam", "aim", "power", "water", "vignetting", "altitude", "attitude", "gain"};
constexpr std::size_t kByDefault = 5;

bool is_asked(const FitOptions& options, const std::string& word) {
    if (!options.free)
        return std::find(kWords.begin(), kWords.begin() + kByDefault, word) !=
               kWords.begin() + kByDefault;
    return std::ranges::find(*options.free, word) != options.free->end();
}

void require_known(const FitOptions& options) {
    for (const std::string& word : options.free.value_or(std::vector<std::string>{})) {
        if (std::ranges::find(kWords, word) != kWords.end() || word.starts_with("water.")) continue;
        throw InputError(
            "--free: found '{}'; allowed: {}, or a number of [water] as "
            "water.multiple",
            word,
            fmt::join(kWords, ", "));
    }
}

bool is_case_1(const RigText& rig) {
    return rig.has("water.chlorophyll_mg_m3");
}

// The water's numbers, which the state holds whether they are free or not.
void add_water(const RigText& text,
               const Rig& rig,
               const FitOptions& options,
               FitState& state,
               std::vector<Free>& free) {
    const auto add = [&](const WaterBounds& bounds, bool is_free) {
        const std::string key = fmt::format("water.{}", bounds.key);
        const double value = text.number(key).value_or(bounds.absent);
        if (is_free) {
            free.push_back({.number = {FitPart::Water, state.water.size(), 0},
                            .key = key,
                            .plausible = std::max(bounds.plausible, 0.5 * value),
                            .least = bounds.least,
                            .most = bounds.most,
                            .group = "water"});
            state.water.push_back({.key = key, .value = value});
        }
    };
    const auto by_itself = [&](const char* key) {
        return options.free && std::ranges::find(*options.free, fmt::format("water.{}", key)) !=
                                   options.free->end();
    };
    if (is_case_1(text)) {
        for (WaterBounds bounds : kCase1Numbers) {
            // What the reader takes where cdom is not told.
            if (std::string_view(bounds.key) == "cdom_440_per_m")
                bounds.absent = case_1_cdom_440_per_m(*text.number("water.chlorophyll_mg_m3"));
            add(bounds, is_asked(options, "water") || by_itself(bounds.key));
        }
    } else {
        const bool is_all = is_asked(options, "water") && rig.water.multiple > 0.0;
        add(kWaterNumbers[0], is_all || by_itself("multiple"));
    }
    add(kWaterNumbers[1], by_itself("uniform_loss_per_m"));
}

// Strobes of like beams share one, unless each is to have its own.
void add_beams(const Rig& rig,
               const FitOptions& options,
               double widest_rad,
               FitState& state,
               std::vector<Free>& free) {
    std::vector<std::string> signatures;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const Beam& beam = rig.strobes[s].beam;
        const std::string signature =
            options.has_beam_each ? fmt::format("{}", s) : beam_signature(beam);
        const auto same = std::ranges::find(signatures, signature);
        state.beam_of.push_back(static_cast<std::size_t>(same - signatures.begin()));
        if (same != signatures.end()) continue;
        signatures.push_back(signature);
        const std::string name = rig.strobes[s].name;
        if (!is_asked(options, "beam")) {
            state.beams.push_back(FitBeam::held(beam));
        } else if (options.beam == FitBeamKind::Table) {
            state.beams.push_back(FitBeam::table(options.parts, widest_rad));
        } else if (options.beam == FitBeamKind::Cones) {
            state.beams.push_back(FitBeam::cones(beam));
        } else if (options.beam == FitBeamKind::Cosine) {
            state.beams.push_back(
                FitBeam::cosine(beam.cones.empty() ? 1.0 : beam.cones.front().exponent));
        } else {
            state.beams.push_back(FitBeam::optics(beam));
        }
        const FitBeam& made = state.beams.back();
        for (std::size_t k = 0; k < made.shapes().size(); ++k) {
            const double shape = made.shapes()[k];
            free.push_back({.number = {FitPart::BeamShape, state.beams.size() - 1, k},
                            .key = fmt::format("strobe.{}.beam.{}", name, made.shape_names()[k]),
                            .plausible = std::max(0.3 * shape, 1e-3),
                            .least = 0.05 * shape,
                            .most = 50.0 * std::max(shape, 1e-3),
                            .group = "beam"});
        }
    }
}

void add_strobes(const Rig& rig,
                 const FitOptions& options,
                 FitState& state,
                 std::vector<Free>& free) {
    constexpr double kMostTurn_rad = 0.8;
    std::set<std::size_t> seen;  // beams whose first strobe has the power 1
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const std::string& name = rig.strobes[s].name;
        for (std::size_t k = 0; k < 2 && is_asked(options, "aim"); ++k) {
            free.push_back(
                {.number = {FitPart::Aim, s, k},
                 .key = fmt::format("strobe.{}.aim_{}_deg", name, k == 0 ? "along" : "across"),
                 .plausible = 10.0 * kRadiansPerDegree,
                 .least = -kMostTurn_rad,
                 .most = kMostTurn_rad,
                 .per_unit = kDegreesPerRadian,
                 .group = "aim"});
        }
        const bool is_first = seen.insert(state.beam_of[s]).second;
        if (is_first || !is_asked(options, "power") || state.power[s] <= 0.0) continue;
        free.push_back({.number = {FitPart::Power, s, 0},
                        .key = fmt::format("strobe.{}.power", name),
                        .plausible = 0.5 * state.power[s],
                        .least = 1e-3 * state.power[s],
                        .most = 1e3 * state.power[s],
                        .group = "power"});
    }
}

void add_camera(const Rig& rig,
                const FitOptions& options,
                const FitLight&,
                FitState& state,
                std::vector<Free>& free) {
    if (is_asked(options, "vignetting")) {
        const RadialVignetting radial = radial_like(rig.camera);
        state.vignetting.assign(radial.a.begin(), radial.a.end());
        for (std::size_t k = 0; k < state.vignetting.size(); ++k) {
            free.push_back({.number = {FitPart::LensFactor, 0, k},
                            .key = fmt::format("camera.vignetting.a{}", k + 1),
                            .plausible = 0.5,
                            .group = "vignetting"});
        }
    }
    constexpr double kMostTilt_rad = 0.5;
    if (is_asked(options, "altitude")) {
        free.push_back({.number = {FitPart::Offset, 0, 0},
                        .key = "sled.altitude_offset_m",
                        .plausible = 0.2,
                        .least = -0.3 * rig.sled.altitude_m,
                        .most = 0.3 * rig.sled.altitude_m,
                        .group = "altitude"});
    }
    for (std::size_t k = 1; k <= 2 && is_asked(options, "attitude"); ++k) {
        free.push_back({.number = {FitPart::Offset, 0, k},
                        .key = k == 1 ? "camera.pitch_offset_deg" : "camera.roll_offset_deg",
                        .plausible = 3.0 * kRadiansPerDegree,
                        .least = -kMostTilt_rad,
                        .most = kMostTilt_rad,
                        .per_unit = kDegreesPerRadian,
                        .group = "attitude"});
    }
    if (rig.camera.sensor.is_mono()) return;
    if (!is_asked(options, "gain")) {
        for (std::size_t k = 0; k < state.floor.size(); ++k) {
            free.push_back({.number = {FitPart::FloorColour, 0, k},
                            .key = k == 0 ? "floor.redness" : "floor.bend",
                            .plausible = 1.0,
                            .group = "floor"});
        }
        return;
    }
    for (const std::size_t c : {std::size_t{0}, std::size_t{2}}) {
        free.push_back({.number = {FitPart::Gain, c, 0},
                        .key = fmt::format("gain.{}", kChannelNames[c]),
                        .plausible = 1e3,
                        .least = 1e-6,
                        .most = 1e6,
                        .group = "gain"});
    }
}

struct Problem {
    FitState state;
    std::vector<Free> free;

    [[nodiscard]] std::vector<FitNumber> numbers() const {
        std::vector<FitNumber> all;
        for (const Free& one : free) all.push_back(one.number);
        return all;
    }
    [[nodiscard]] FitState at(const double* x) const {
        FitState moved = state;
        for (std::size_t k = 0; k < free.size(); ++k)
            number_in(moved, free[k].number) = x[k] * free[k].plausible;
        return moved;
    }
};

Problem problem_of(const RigText& text,
                   const Rig& rig,
                   const FitOptions& options,
                   const FitLight& light,
                   double widest_rad) {
    Problem problem;
    FitState& state = problem.state;
    for (const Strobe& strobe : rig.strobes) {
        state.power.push_back(strobe.power);
        state.aim_rad.push_back({0.0, 0.0});
    }
    add_water(text, rig, options, state, problem.free);
    add_beams(rig, options, widest_rad, state, problem.free);
    add_strobes(rig, options, state, problem.free);
    add_camera(rig, options, light, state, problem.free);
    for (Free& one : problem.free) one.start = number_in(state, one.number);
    return problem;
}

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

std::vector<Index> active_parts(const VectorXd& shares) {
    std::vector<Index> active;
    for (Index m = 0; m < shares.size(); ++m)
        if (shares(m) > 0.0) active.push_back(m);
    return active;
}

// H of the numbers with the shares eliminated: Kaufman's.
MatrixXd eliminated(const MatrixXd& H,
                    const std::vector<Index>& parts,
                    const std::vector<Index>& numbers) {
    const MatrixXd of_numbers = H(numbers, numbers);
    if (parts.empty() || numbers.empty()) return of_numbers;
    const VectorXd scale =
        H.diagonal()(parts).cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
    MatrixXd of_parts = scale.asDiagonal() * MatrixXd(H(parts, parts)) * scale.asDiagonal();
    constexpr double kRounding = 1e-12;
    of_parts.diagonal().array() += kRounding;
    const MatrixXd across = scale.asDiagonal() * MatrixXd(H(parts, numbers));
    return of_numbers - across.transpose() * of_parts.ldlt().solve(across);
}

std::vector<Index> range_of(Index from, Index count) {
    std::vector<Index> all;
    for (Index i = 0; i < count; ++i) all.push_back(from + i);
    return all;
}

// The objective for Ceres, in n + 1 residuals that have its value, gradient and Gauss-Newton
// matrix: all that its trust region asks for. So a million blocks come as some twenty rows.
class Reduced : public ceres::CostFunction {
  public:
    Reduced(const Bench& bench, const Problem& problem) : bench_(bench), problem_(problem) {
        const auto count = static_cast<int>(problem.free.size());
        mutable_parameter_block_sizes()->push_back(count);
        set_num_residuals(count + 1);
    }

    bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
        const bool has_slopes = jacobians != nullptr && jacobians[0] != nullptr;
        const FitState state = problem_.at(x[0]);
        const auto count = static_cast<Index>(problem_.free.size());
        const PathLight light = bench_.path_light(state, has_slopes);
        const Solved solved = shares_of(bench_.equations.parts(state, light));
        VectorXd off(count);  // from where it began
        double squares = solved.squares;
        for (Index k = 0; k < count; ++k) {
            const Free& one = problem_.free[static_cast<std::size_t>(k)];
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
        MatrixXd S = scale.asDiagonal() *
                     eliminated(normal.H, active_parts(solved.shares), range_of(parts, count)) *
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
    const Bench& bench_;
    const Problem& problem_;
};

// Moves the problem's state to the least of the objective. Steps that it took.
int search(const Bench& bench, Problem& problem, int most_steps) {
    if (problem.free.empty()) return 0;
    std::vector<double> x;
    for (const Free& one : problem.free)
        x.push_back(number_in(problem.state, one.number) / one.plausible);
    ceres::Problem minimised;
    minimised.AddResidualBlock(new Reduced(bench, problem), nullptr, x.data());
    for (std::size_t k = 0; k < x.size(); ++k) {
        const Free& one = problem.free[k];
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
void start_gains(const Bench& bench, Problem& problem) {
    const auto gains = bench.equations.gains(problem.state, bench.path_light(problem.state, false));
    for (Free& one : problem.free) {
        if (one.number.part != FitPart::Gain) continue;
        one.start = gains[one.number.of];
        number_in(problem.state, one.number) = one.start;
    }
}

// How well the data alone tell the numbers, in units of what is plausible; `without` leaves out
// columns of H.
VectorXd told_errors(const MatrixXd& H,
                     const std::vector<Index>& parts,
                     const std::vector<Index>& numbers,
                     const std::vector<Free>& free,
                     Index first_number) {
    VectorXd scale(static_cast<Index>(numbers.size()));
    for (Index k = 0; k < scale.size(); ++k)
        scale(k) =
            free[static_cast<std::size_t>(numbers[static_cast<std::size_t>(k)] - first_number)]
                .plausible;
    const MatrixXd S = scale.asDiagonal() * eliminated(H, parts, numbers) * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(S);
    constexpr double kNothing = 1e-9;
    const VectorXd variances =
        solver.eigenvalues()
            .cwiseMax(kNothing * std::max(1.0, solver.eigenvalues().maxCoeff()))
            .cwiseInverse();
    return (solver.eigenvectors().array().square().matrix() * variances).cwiseSqrt();
}

struct Told {
    const MatrixXd& H;
    std::vector<Index> parts;
    const std::vector<Free>& free;
    Index first_number;
    // With a group of numbers known, or the beam.
    [[nodiscard]] VectorXd errors(const MatrixXd& H_of, const std::string& known) const {
        std::vector<Index> numbers;
        std::vector<Index> at;
        for (Index k = 0; k < static_cast<Index>(free.size()); ++k) {
            if (free[static_cast<std::size_t>(k)].group == known) continue;
            numbers.push_back(first_number + k);
            at.push_back(k);
        }
        VectorXd all = VectorXd::Zero(static_cast<Index>(free.size()));
        const std::vector<Index> none;
        // A known beam has its level free all the same: that is the part of it which the shares
        // are.
        all(at) = told_errors(known == "beam" ? with_level(H_of) : H_of,
                              known == "beam" ? std::vector<Index>{0} : parts,
                              numbers,
                              free,
                              first_number);
        return all;
    }
    // H with the first part standing for all, as they are.
    [[nodiscard]] MatrixXd with_level(const MatrixXd& H_of) const {
        MatrixXd turned = H_of;
        const VectorXd of_all = H_of.leftCols(first_number) * shares;
        turned.col(0) = of_all;
        turned.row(0) = of_all.transpose();
        turned(0, 0) = shares.dot(of_all.head(first_number));
        return turned;
    }
    const VectorXd& shares;
};

std::vector<NotTold> not_told(const Bench& bench,
                              const Problem& problem,
                              const PathLight& light,
                              const Told& told,
                              const std::vector<Sled>& sleds) {
    std::vector<NotTold> all;
    const VectorXd errors = told.errors(told.H, "");
    std::vector<Index> bad;
    for (Index k = 0; k < errors.size(); ++k) {
        const Free& one = told.free[static_cast<std::size_t>(k)];
        if (errors(k) <= kTold || one.group == "gain" || one.group == "floor") continue;
        NotTold not_one{.key = one.key, .error = errors(k) * one.plausible * one.per_unit};
        double best = errors(k);
        for (const std::string group : {"beam",
                                        "water",
                                        "aim",
                                        "power",
                                        "vignetting",
                                        "altitude",
                                        "attitude",
                                        "floor",
                                        "gain"}) {
            if (group == one.group) continue;
            const double error = told.errors(told.H, group)(k);
            if (error >= 0.9 * best) continue;
            best = error;
            not_one.confounded_with = group;
        }
        all.push_back(not_one);
        bad.push_back(k);
    }
    if (all.empty()) return all;
    // How to fly instead: the nearest altitude from which as many images again tell most.
    const auto [low, high] = std::ranges::minmax(sleds, {}, &Sled::altitude_m);
    for (const double altitude_m : {1.5 * high.altitude_m,
                                    low.altitude_m / 1.5,
                                    2.0 * high.altitude_m,
                                    low.altitude_m / 2.0}) {
        const auto count = static_cast<double>(sleds.size());
        MatrixXd H = told.H;
        try {
            H += count * bench.equations.normal_of(problem.state,
                                                   light,
                                                   told.shares,
                                                   problem.numbers(),
                                                   {.altitude_m = altitude_m});
        } catch (const InputError&) {
            continue;
        }
        const VectorXd then = told.errors(H, "");
        for (std::size_t i = 0; i < bad.size(); ++i) {
            const Free& one = told.free[static_cast<std::size_t>(bad[i])];
            if (then(bad[i]) > kTold) continue;
            if (all[i].fly_at_m) continue;
            all[i].fly_at_m = altitude_m;
            all[i].error_then = then(bad[i]) * one.plausible * one.per_unit;
        }
    }
    return all;
}

}  // namespace

std::string words_of(const NotTold& one) {
    std::string words = fmt::format("{} cannot be told", one.key);
    if (!one.confounded_with.empty()) words += fmt::format(" apart from {}", one.confounded_with);
    words += fmt::format(" (by these images alone to +-{:.2g})", one.error);
    if (one.fly_at_m) {
        words += fmt::format("; as many images again at {:.2g} m would tell it to +-{:.2g}",
                             *one.fly_at_m,
                             one.error_then);
    }
    return words;
}

namespace {

std::vector<Sled> sleds_of(const FitSamples& samples) {
    std::vector<Sled> sleds;
    for (const FitImage& image : samples.images) sleds.push_back(image.sled);
    return sleds;
}

// Covariance of shares and numbers; rows of what is held at 0 are 0.
MatrixXd covariance_of(const FitEquations::Normal& normal,
                       const VectorXd& shares,
                       const std::vector<Free>& free,
                       double huber_factor) {
    const Index parts = shares.size();
    std::vector<Index> active = active_parts(shares);
    for (const Index k : range_of(parts, static_cast<Index>(free.size()))) active.push_back(k);
    MatrixXd H = normal.H(active, active);
    for (Index k = 0; k < static_cast<Index>(free.size()); ++k) {
        const Index at = H.rows() - static_cast<Index>(free.size()) + k;
        H(at, at) += std::pow(free[static_cast<std::size_t>(k)].plausible, -2.0);
    }
    const VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
    MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
    constexpr double kRounding = 1e-13;
    scaled.diagonal().array() += kRounding;
    const Eigen::LDLT<MatrixXd> solver(scaled);
    const MatrixXd inverse = solver.solve(MatrixXd::Identity(H.rows(), H.rows()));
    MatrixXd C = inverse;
    // The sandwich wants several tiles for each number.
    constexpr std::size_t kTilesOfEach = 5;
    if (normal.tiles > kTilesOfEach * active.size()) {
        const MatrixXd meat =
            scale.asDiagonal() * MatrixXd(normal.meat(active, active)) * scale.asDiagonal();
        const double few =
            static_cast<double>(normal.tiles) / static_cast<double>(normal.tiles - active.size());
        C = few * huber_factor * huber_factor * inverse * meat * inverse;
        // What few tiles see has too small a sandwich; none is smaller than H's own.
        const VectorXd wider =
            inverse.diagonal().cwiseQuotient(C.diagonal()).cwiseSqrt().cwiseMax(1.0);
        C = wider.asDiagonal() * C * wider.asDiagonal();
    }
    C = scale.asDiagonal() * C * scale.asDiagonal();
    MatrixXd all = MatrixXd::Zero(normal.H.rows(), normal.H.cols());
    all(active, active) = C;
    return all;
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

// Sums over images of the residual at one place and channel.
struct InPlace {
    double sum = 0.0;
    double squares = 0.0;
    double count = 0.0;
};

// How much of the residuals stays in place from image to image: rms of the means, less what chance
// makes of them.
double pattern_of(const std::vector<InPlace>& places) {
    constexpr double kFew = 3.0;
    double pattern = 0.0;
    double counted = 0.0;
    for (const InPlace& at : places) {
        if (at.count < kFew) continue;
        const double mean = at.sum / at.count;
        const double chance = (at.squares / at.count - mean * mean) / (at.count - 1.0);
        pattern += mean * mean - chance;
        counted += 1.0;
    }
    return std::sqrt(std::max(0.0, pattern) / std::max(1.0, counted));
}

double correlation_with_altitude(const std::vector<ImageOutcome>& images) {
    const auto count = static_cast<Index>(images.size());
    VectorXd altitude(count);
    VectorXd level(count);
    for (Index i = 0; i < count; ++i) {
        const ImageOutcome& image = images[static_cast<std::size_t>(i)];
        altitude(i) = image.sled.altitude_m;
        level(i) = image.level;
    }
    altitude.array() -= altitude.mean();
    level.array() -= level.mean();
    const double size = altitude.norm() * level.norm();
    return size > 0.0 ? altitude.dot(level) / size : 0.0;
}

void look_for_doubts(const FitSamples& samples, FitResult& result) {
    constexpr double kPattern = 0.02;
    if (result.pattern > kPattern) {
        result.doubts.push_back(
            {"residuals stay in place from image to image: another beam, lens or "
             "water than the fit allows, or a wrong black level; rms",
             result.pattern});
    }
    constexpr double kSaturated = 0.02;
    double saturated = 0.0;
    for (const FitImage& image : samples.images)
        saturated += image.saturated_share / static_cast<double>(samples.images.size());
    if (saturated > kSaturated)
        result.doubts.push_back({"saturated samples, left out; share", saturated});
    constexpr std::size_t kFew = 10;
    constexpr double kSigmas = 4.0;  // of the correlation of as many images by chance
    const double correlation = correlation_with_altitude(result.images);
    if (result.images.size() >= kFew &&
        std::abs(correlation) > kSigmas / std::sqrt(static_cast<double>(result.images.size()))) {
        result.doubts.push_back(
            {"what is left of the images' brightness goes with their altitude; correlation",
             correlation});
    }
    constexpr double kMostLevel = 0.25;
    const double level = std::sqrt(result.effects[0]);
    if (level > kMostLevel) {
        result.doubts.push_back(
            {"images are brighter or darker than their poses explain: poses of "
             "other images, or other exposures; rms",
             level});
    }
}

FitView view_of(std::size_t image, const FitSamples& samples, const FitEquations::Residual& found) {
    const std::size_t places = samples.places.size();
    FitView view{.image = image,
                 .observed = std::vector<float>(places * kChannels),
                 .fitted = std::vector<float>(places * kChannels),
                 .residual = std::vector<float>(places, 0.0F)};
    for (std::size_t i = 0; i < places; ++i) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            const auto row = static_cast<Index>(kChannels * i + c);
            view.observed[c * places + i] = samples.images[image].signal[kChannels * i + c];
            view.fitted[c * places + i] = static_cast<float>(found.signal(row));
            view.residual[i] +=
                static_cast<float>(found.residual(row) / found.signal(row) / kChannels);
        }
    }
    return view;
}

// The images nearest to even steps of altitude.
std::vector<std::size_t> images_to_show(const FitSamples& samples) {
    std::vector<std::size_t> order(samples.images.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return samples.images[i].sled.altitude_m; });
    const std::size_t count = std::min(kFitViews, order.size());
    std::vector<std::size_t> shown;
    for (std::size_t k = 0; k < count; ++k)
        shown.push_back(order[count == 1 ? 0 : k * (order.size() - 1) / (count - 1)]);
    return shown;
}

void look_at_residuals(const Bench& bench,
                       const FitSamples& samples,
                       const PathLight& light,
                       FitResult& result) {
    constexpr double kDim = 0.05;  // of an image's brightest: darker blocks are noise
    std::vector<InPlace> places(samples.places.size() * kChannels);
    const std::vector<std::size_t> shown = images_to_show(samples);
    result.views.resize(shown.size());
    double squares = 0.0;
    double blocks = 0.0;
    for (std::size_t i = 0; i < samples.images.size(); ++i) {
        const FitEquations::Residual found =
            bench.equations.residual_of(i, result.state, light, result.shares);
        const double most = found.signal.maxCoeff();
        double of_image = 0.0;
        double count = 0.0;
        for (Index row = 0; row < found.residual.size(); ++row) {
            if (!std::isfinite(found.residual(row)) || found.signal(row) < kDim * most) continue;
            const double off = found.residual(row) / found.signal(row);
            InPlace& at = places[static_cast<std::size_t>(row)];
            at.sum += off;
            at.squares += off * off;
            at.count += 1.0;
            of_image += off * off;
            count += 1.0;
        }
        squares += of_image;
        blocks += count;
        result.images.push_back({.sled = samples.images[i].sled,
                                 .residual = std::sqrt(of_image / std::max(1.0, count)),
                                 .level = found.effects[0],
                                 .altitude_m = found.effects[3]});
        const auto at = std::ranges::find(shown, i);
        if (at != shown.end())
            result.views[static_cast<std::size_t>(at - shown.begin())] = view_of(i, samples, found);
    }
    result.residual = std::sqrt(squares / std::max(1.0, blocks));
    result.pattern = pattern_of(places);
    look_for_doubts(samples, result);
}

FitResult result_of(const Bench& bench,
                    const Problem& problem,
                    const FitSamples& samples,
                    std::vector<NotTold>& untold) {
    const PathLight light = bench.path_light(problem.state, true);
    const Solved solved = shares_of(bench.equations.parts(problem.state, light));
    const FitEquations::Normal normal =
        bench.equations.normal(problem.state, light, solved.shares, problem.numbers(), true);
    FitResult result;
    result.state = problem.state;
    result.shares = solved.shares;
    result.covariance =
        covariance_of(normal, solved.shares, problem.free, bench.equations.huber_factor());
    result.effects = bench.equations.effects();
    result.noise = bench.equations.noise();
    result.blocks = bench.equations.blocks();
    result.tiles = normal.tiles;
    const Index parts = solved.shares.size();
    for (std::size_t k = 0; k < problem.free.size(); ++k) {
        const Free& one = problem.free[k];
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
    constexpr double kConfounded = 0.9;
    for (std::size_t i = 0; i < problem.free.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Index a = parts + static_cast<Index>(i);
            const Index b = parts + static_cast<Index>(j);
            const double scale = std::sqrt(result.covariance(a, a) * result.covariance(b, b));
            const double correlation = scale > 0.0 ? result.covariance(a, b) / scale : 0.0;
            if (std::abs(correlation) > kConfounded)
                result.confounded.push_back(
                    {problem.free[j].key, problem.free[i].key, correlation});
        }
    }
    std::ranges::sort(result.confounded, [](const Confounded& a, const Confounded& b) {
        return std::abs(a.correlation) > std::abs(b.correlation);
    });
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
    const Told told{.H = normal.H,
                    .parts = active_parts(solved.shares),
                    .free = problem.free,
                    .first_number = parts,
                    .shares = solved.shares};
    untold = problem.free.empty() ? std::vector<NotTold>{}
                                  : not_told(bench, problem, light, told, sleds_of(samples));
    look_at_residuals(bench, samples, light, result);
    return result;
}

}  // namespace

FitResult fit(const RigText& text,
              const FitSamples& samples,
              const FitOptions& options,
              const RunWatch& watch) {
    require_known(options);
    const Rig rig = text.rig();
    if (!rig.objects.empty() || !rig.scene.empty())
        throw InputError(
            "found objects or a scene; allowed: the bare floor, which a survey shows on average");
    const FitLight light(rig, samples.places);
    const std::vector<Sled> sleds = sleds_of(samples);
    const PathRange paths = light.paths(sleds);
    if (paths.longest_m <= 0.0) throw InputError("no image sees the floor");
    FitEquations equations(light, samples, options.threads);
    Problem problem = problem_of(text, rig, options, light, light.widest_rad(sleds));
    const Bench bench{.rig = text, .light = light, .equations = equations, .paths = paths};

    EffectVariances effects{};
    constexpr double kLevel = 0.05;  // of floors, at first
    constexpr double kHue = 0.02;
    const double altitude = options.altitude_error_m * options.altitude_error_m;
    const double attitude = options.attitude_error_rad * options.attitude_error_rad;
    const bool is_exact = altitude + attitude == 0.0 && samples.are_maps;
    const double level = is_exact ? 0.0 : kLevel * kLevel;
    const double hue = is_exact ? 0.0 : kHue * kHue;
    effects = {level, hue, hue, altitude, attitude, attitude};
    constexpr std::size_t kManyImages = 30;  // that tell the variances of what they share
    const bool learns_effects = samples.images.size() >= kManyImages;

    std::vector<NotTold> held;
    FitResult result;
    constexpr int kRounds = 4;
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
            equations.learn_noise(problem.state, path_light, solved.shares, learns_effects);
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
            const auto at = std::ranges::find(problem.free, one.key, &Free::key);
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
