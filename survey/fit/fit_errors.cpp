// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_errors.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Sandwich {
    MatrixXd known;             // R^T R
    MatrixXd curvature;         // A
    MatrixXd inverse;           // A^-1
    MatrixXd scores;            // sum s s^T
    std::ptrdiff_t images = 0;  // that count

    [[nodiscard]] MatrixXd covariance() const { return inverse * (scores + known) * inverse; }
    // Of the difference between the solutions of two halves.
    [[nodiscard]] MatrixXd of_halves() const {
        const MatrixXd half = MatrixXd(0.5 * (curvature + known))
                                  .llt()
                                  .solve(MatrixXd::Identity(known.rows(), known.cols()));
        return half * scores * half;
    }
};

Sandwich sandwich_at(const FitObjective& objective, const FitPoint& point) {
    std::vector<ImageTerms> terms = objective.terms_at(point, Curvature::Observed);
    Sandwich of{.known = objective.curvature_of({}),
                .curvature = objective.curvature_of(terms),
                .inverse = {},
                .scores = {}};
    // Far from a solution, the t's curvature can be negative: its majorant is used instead.
    if (of.curvature.llt().info() != Eigen::Success) {
        terms = objective.terms_at(point, Curvature::Majorant);
        of.curvature = objective.curvature_of(terms);
    }
    const auto one = MatrixXd::Identity(of.known.rows(), of.known.cols());
    of.inverse = of.curvature.llt().solve(one);
    of.scores.setZero(one.rows(), one.cols());
    for (const ImageTerms& image : terms) {
        const VectorXd s = (one - image.H * of.inverse).partialPivLu().solve(image.g);
        of.scores += s * s.transpose();
        if (image.weights.back() > 0.0) ++of.images;
    }
    return of;
}

// M, the mean of J^T J over blocks and channels, at poses of the flight; J: slopes over x of the
// map's logarithm less the level of a mean floor. The map's variance is trace(M C).
MatrixXd map_moments(const FitObjective& objective, const FitPoint& point) {
    const FitModel model = objective.model_at(point.x);
    const Index count = point.x.size();
    const auto q = static_cast<double>(objective.channels());
    MatrixXd sum = MatrixXd::Zero(count, count);
    MatrixXd level = MatrixXd::Zero(static_cast<Index>(objective.channels()), count);
    double blocks = 0.0;
    const std::size_t apart = (point.pose.size() + kFewPoses - 1) / kFewPoses;
    for (std::size_t i = 0; i < point.pose.size(); i += apart) {
        const ImageView view = objective.view(point, model, i);
        const auto slopes = view.rows.middleCols(1, count);  // 0 of blocks that do not count
        sum += slopes.transpose() * slopes;
        level += static_cast<double>(view.blocks) * view.level.middleCols(1, count);
        blocks += static_cast<double>(view.blocks);
    }
    blocks = std::max(blocks, 1.0);
    return (sum - level.transpose() * level / blocks) / (q * blocks);
}

// By number, for one split: squared differences of its halves over their predicted variances,
// averaged over the number's word, and over all together as far as those are few.
VectorXd by_word(const FitProblem& problem, const VectorXd& squares) {
    struct Sum {
        double squares = 0.0;
        double count = 0.0;
    };
    Sum all;
    std::map<std::string, Sum> of;
    for (std::size_t k = 0; k < problem.numbers.size(); ++k) {
        for (Sum* sum : {&all, &of[problem.numbers[k].word]}) {
            sum->squares += squares(static_cast<Index>(k));
            sum->count += 1.0;
        }
    }
    VectorXd means(squares.size());
    for (std::size_t k = 0; k < problem.numbers.size(); ++k) {
        const Sum& own = of[problem.numbers[k].word];
        means(static_cast<Index>(k)) =
            (kOfAll * all.squares / all.count + own.squares) / (kOfAll + own.count);
    }
    return means;
}

}  // namespace

double dispersion_at(const FitObjective& objective, const FitPoint& point) {
    const Sandwich of = sandwich_at(objective, point);
    if (of.images < kFewestImages) return point.dispersion;
    // S at the point is divided by the point's own dispersion.
    return std::max(1.0,
                    point.dispersion * (of.inverse * of.scores).trace() /
                        (of.inverse * (of.curvature - of.known)).trace());
}

MatrixXd without_common_power(const FitProblem& problem, const std::vector<double>& powers) {
    const auto count = std::ssize(problem.numbers);
    MatrixXd keep = MatrixXd::Identity(count, count);
    if (powers.size() < 2) return keep;
    const double all = std::accumulate(powers.begin(), powers.end(), 0.0);
    for (Index other = 0; other < count; ++other) {
        const FitPlaceInState& at = problem.numbers[static_cast<std::size_t>(other)].at;
        if (at.part != FitPart::Power) continue;
        for (Index one = 0; one < count; ++one)
            if (problem.numbers[static_cast<std::size_t>(one)].at.part == FitPart::Power)
                keep(one, other) -= powers[at.of] / all;
    }
    return keep;
}

FitErrors errors_of(const FitObjective& objective,
                    const FitProblem& problem,
                    const FitPoint& point,
                    const std::vector<double>& powers,
                    const std::function<FitPoint(std::size_t, std::size_t)>& half) {
    const auto count = std::ssize(problem.numbers);
    const MatrixXd keep = without_common_power(problem, powers);
    const Sandwich sandwich = sandwich_at(objective, point);
    const MatrixXd M = map_moments(objective, point);
    const auto map_variance = [&](const MatrixXd& covariance) {
        return std::max(0.0, (M * covariance).trace());
    };
    const bool are_few = sandwich.images < kFewestImages;
    const MatrixXd C = are_few ? sandwich.inverse : sandwich.covariance();
    FitErrors errors{.covariance = keep * C.topLeftCorner(count, count) * keep.transpose(),
                     .unevenness = std::sqrt(map_variance(C))};
    if (are_few) return errors;
    const MatrixXd wanted = sandwich.of_halves();
    // Halves do not differ in numbers that no image shows, such as the aim of a lamp that is off.
    constexpr double kNothing = std::numeric_limits<double>::min();
    const VectorXd variances = (keep * wanted.topLeftCorner(count, count) * keep.transpose())
                                   .diagonal()
                                   .cwiseMax(kNothing);
    const double expected = std::max(map_variance(wanted), kNothing);
    VectorXd log_squares = VectorXd::Zero(count);
    double map_log_square = 0.0;
    for (std::size_t split = 0; split < kSplits; ++split) {
        const VectorXd apart = half(split, 1).x - half(split, 0).x;
        const VectorXd squares = (keep * apart.head(count)).cwiseAbs2().cwiseQuotient(variances);
        log_squares.array() += by_word(problem, squares).array().log() / kSplits;
        map_log_square += std::log(map_variance(apart * apart.transpose()) / expected) / kSplits;
    }
    VectorXd F = (0.5 * log_squares).array().exp().max(1.0);
    for (Index k = 0; k < count; ++k)
        if (problem.numbers[static_cast<std::size_t>(k)].at.part == FitPart::Aim)
            F(k) *= kAimWidening;
    errors.covariance = F.asDiagonal() * errors.covariance * F.asDiagonal();
    errors.unevenness *= std::max(1.0, std::exp(0.5 * map_log_square));
    return errors;
}

}  // namespace aphotic
