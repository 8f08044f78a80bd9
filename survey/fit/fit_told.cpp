// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_told.h"

#include "base/error.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

std::vector<Index> range_of(Index from, Index count) {
    std::vector<Index> all;
    for (Index i = 0; i < count; ++i) all.push_back(from + i);
    return all;
}

}  // namespace

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
    MatrixXd of_numbers = H(numbers, numbers);
    if (parts.empty() || numbers.empty()) return of_numbers;
    const VectorXd scale =
        H.diagonal()(parts).cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
    MatrixXd of_parts = scale.asDiagonal() * MatrixXd(H(parts, parts)) * scale.asDiagonal();
    constexpr double kRounding = 1e-12;
    of_parts.diagonal().array() += kRounding;
    const MatrixXd across = scale.asDiagonal() * MatrixXd(H(parts, numbers));
    return of_numbers - across.transpose() * of_parts.ldlt().solve(across);
}

namespace {

// How well the data alone tell the numbers, in units of what is plausible; `without` leaves out
// columns of H.
VectorXd told_errors(const MatrixXd& H,
                     const std::vector<Index>& parts,
                     const std::vector<Index>& numbers,
                     const std::vector<FreeNumber>& free,
                     Index first_number) {
    if (numbers.empty()) return {};  // all are held
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

std::vector<Index> seen_parts(const MatrixXd& H, Index parts) {
    std::vector<Index> seen;
    for (Index m = 0; m < parts; ++m)
        if (H(m, m) > 0.0) seen.push_back(m);
    return seen;
}

// Numbers, and how well the images alone tell them.
struct Told {
    const MatrixXd& H;
    std::vector<Index> parts;
    const std::vector<FreeNumber>& free;
    Index first_number;
    const VectorXd& shares;
    std::vector<bool> is_held;

    // With a group of numbers known, or the beam; 0 of what is known or held.
    [[nodiscard]] VectorXd errors(const MatrixXd& H_of, const std::string& known) const {
        std::vector<Index> numbers;
        std::vector<Index> at;
        for (Index k = 0; k < static_cast<Index>(free.size()); ++k) {
            const auto at_free = static_cast<std::size_t>(k);
            if (is_held[at_free] || free[at_free].group == known) continue;
            numbers.push_back(first_number + k);
            at.push_back(k);
        }
        const VectorXd found = known == "beam"
                                   ? errors_with_beam(H_of, numbers)
                                   : told_errors(H_of, parts, numbers, free, first_number);
        VectorXd all = VectorXd::Zero(static_cast<Index>(free.size()));
        for (std::size_t i = 0; i < at.size(); ++i) all(at[i]) = found(static_cast<Index>(i));
        return all;
    }

    // A known beam has its level free all the same: the first part stands for all, as they are.
    [[nodiscard]] VectorXd errors_with_beam(const MatrixXd& H_of,
                                            const std::vector<Index>& numbers) const {
        MatrixXd turned = H_of;
        const VectorXd of_all = H_of.leftCols(first_number) * shares;
        turned.col(0) = of_all;
        turned.row(0) = of_all.transpose();
        turned(0, 0) = shares.dot(of_all.head(first_number));
        return told_errors(turned, {0}, numbers, free, first_number);
    }
};

}  // namespace

std::vector<NotTold> not_told(const FitEquations& equations,
                              const FitProblem& problem,
                              const PathLight& light,
                              const MatrixXd& H_of_fit,
                              const VectorXd& shares,
                              const std::vector<Sled>& sleds) {
    if (problem.free.empty()) return {};
    Told told{.H = H_of_fit,
              .parts = active_parts(shares),
              .free = problem.free,
              .first_number = shares.size(),
              .shares = shares,
              .is_held = std::vector<bool>(problem.free.size(), false)};
    std::vector<NotTold> all;
    std::vector<Index> bad;
    // The worst first: with it held the others may be told.
    while (true) {
        VectorXd errors = told.errors(told.H, "");
        for (Index k = 0; k < errors.size(); ++k) {
            const std::string& group = told.free[static_cast<std::size_t>(k)].group;
            if (group == "gain" || group == kFloorColour) errors(k) = 0.0;
        }
        Index k = 0;
        if (errors.maxCoeff(&k) <= kTold) break;
        const FreeNumber& one = told.free[static_cast<std::size_t>(k)];
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
                                        kFloorColour,
                                        "gain"}) {
            if (group == one.group) continue;
            const double error = told.errors(told.H, group)(k);
            if (error >= 0.9 * best) continue;
            best = error;
            not_one.confounded_with = group;
        }
        all.push_back(not_one);
        bad.push_back(k);
        told.is_held[static_cast<std::size_t>(k)] = true;
    }
    if (all.empty()) return all;
    told.is_held.assign(told.is_held.size(), false);
    // How to fly instead: the nearest altitude from which as many images again tell most.
    const auto [low, high] = std::ranges::minmax(sleds, {}, &Sled::altitude_m);
    for (const double altitude_m : {1.5 * high.altitude_m,
                                    low.altitude_m / 1.5,
                                    2.0 * high.altitude_m,
                                    low.altitude_m / 2.0}) {
        const auto count = static_cast<double>(sleds.size());
        MatrixXd H = told.H;
        try {
            H += count * equations.normal_of(problem.state,
                                             light,
                                             told.shares,
                                             problem.numbers(),
                                             {.altitude_m = altitude_m});
        } catch (const InputError&) {
            continue;
        }
        const VectorXd then = told.errors(H, "");
        for (std::size_t i = 0; i < bad.size(); ++i) {
            const FreeNumber& one = told.free[static_cast<std::size_t>(bad[i])];
            if (then(bad[i]) > kTold) continue;
            if (all[i].fly_at_m) continue;
            all[i].fly_at_m = altitude_m;
            all[i].error_then = then(bad[i]) * one.plausible * one.per_unit;
        }
    }
    return all;
}

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

MatrixXd covariance_of(const FitEquations::Normal& normal,
                       const VectorXd& shares,
                       const std::vector<FreeNumber>& free) {
    const Index parts = shares.size();
    // Those at 0 as well: a bound that holds one part makes none of the others surer.
    std::vector<Index> seen = seen_parts(normal.H, parts);
    for (const Index k : range_of(parts, static_cast<Index>(free.size()))) seen.push_back(k);
    MatrixXd H = normal.H(seen, seen);
    // What is plausible, and ties, are random as well.
    MatrixXd meat = MatrixXd::Zero(H.rows(), H.cols());
    if (normal.meat.size() > 0) meat = normal.meat(seen, seen);
    for (Index k = 0; k < static_cast<Index>(free.size()); ++k) {
        const Index at = H.rows() - static_cast<Index>(free.size()) + k;
        const double plausible = std::pow(free[static_cast<std::size_t>(k)].plausible, -2.0);
        H(at, at) += plausible;
        meat(at, at) += plausible;
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
    if (normal.tiles > kTilesOfEach * seen.size()) {
        meat = (scale.asDiagonal() * meat * scale.asDiagonal()).eval();
        const double few =
            static_cast<double>(normal.tiles) / static_cast<double>(normal.tiles - seen.size());
        C = few * inverse * meat * inverse;
        // What few tiles see has too small a sandwich: none is smaller than H's own, less the tenth
        // by which a sandwich of some hundred tiles is off by chance.
        constexpr double kOwn = 0.9;
        const VectorXd wider =
            (kOwn * inverse.diagonal().cwiseQuotient(C.diagonal()).cwiseSqrt()).cwiseMax(1.0);
        C = wider.asDiagonal() * C * wider.asDiagonal();
    }
    C = scale.asDiagonal() * C * scale.asDiagonal();
    MatrixXd all = MatrixXd::Zero(normal.H.rows(), normal.H.cols());
    all(seen, seen) = C;
    return all;
}

std::vector<Confounded> confounded_in(const MatrixXd& covariance,
                                      Index parts,
                                      const std::vector<FreeNumber>& free) {
    std::vector<Confounded> all;
    constexpr double kConfounded = 0.9;
    for (std::size_t i = 0; i < free.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Index a = parts + static_cast<Index>(i);
            const Index b = parts + static_cast<Index>(j);
            const double scale = std::sqrt(covariance(a, a) * covariance(b, b));
            const double correlation = scale > 0.0 ? covariance(a, b) / scale : 0.0;
            if (std::abs(correlation) > kConfounded)
                all.push_back({free[j].key, free[i].key, correlation});
        }
    }
    std::ranges::sort(all, [](const Confounded& a, const Confounded& b) {
        return std::abs(a.correlation) > std::abs(b.correlation);
    });
    return all;
}

}  // namespace aphotic
