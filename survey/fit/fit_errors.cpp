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
using Eigen::RowVectorXd;
using Eigen::VectorXd;

struct Sandwich {
    MatrixXd known;      // R^T R
    MatrixXd curvature;  // A
    MatrixXd inverse;    // A^-1
    MatrixXd scores;     // sum s s^T

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
    }
    return of;
}

// The logarithm of the map by block and channel, at poses of the flight, as slopes over x; the
// level of a mean floor is subtracted.
std::vector<RowVectorXd> map_slopes(const FitObjective& objective, const FitPoint& point) {
    const FitState state = objective.state_at(point);
    const PathLight light = objective.path_light(state);
    const auto q = static_cast<Index>(objective.channels());
    std::vector<RowVectorXd> slopes;
    MatrixXd mean = MatrixXd::Zero(q, point.x.size());
    double blocks = 0.0;
    const std::size_t apart = (point.pose.size() + kFewPoses - 1) / kFewPoses;
    for (std::size_t i = 0; i < point.pose.size(); i += apart) {
        const ImageView view = objective.view(point, state, light, i);
        mean += static_cast<double>(view.blocks) * view.level_slopes.leftCols(point.x.size());
        blocks += static_cast<double>(view.blocks);
        for (Index row = 0; row < view.slopes.rows(); ++row)
            if (std::isfinite(view.residual(row)))
                slopes.emplace_back(view.slopes.row(row).head(point.x.size()));
    }
    mean /= std::max(blocks, 1.0);
    for (std::size_t row = 0; row < slopes.size(); ++row)
        slopes[row] -= mean.row(static_cast<Index>(row) % q);
    return slopes;
}

double mean_variance(const std::vector<RowVectorXd>& slopes, const MatrixXd& covariance) {
    double sum = 0.0;
    for (const RowVectorXd& row : slopes) sum += row.dot(covariance * row.transpose());
    return sum / std::max(1.0, static_cast<double>(slopes.size()));
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
    if (objective.counted(point).size() < kFewestImages) return point.dispersion;
    const Sandwich of = sandwich_at(objective, point);
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
    const std::vector<RowVectorXd> slopes = map_slopes(objective, point);
    const bool are_few = objective.counted(point).size() < kFewestImages;
    const MatrixXd C = are_few ? sandwich.inverse : sandwich.covariance();
    FitErrors errors{.covariance = keep * C.topLeftCorner(count, count) * keep.transpose(),
                     .unevenness = std::sqrt(mean_variance(slopes, C))};
    if (are_few) return errors;
    const MatrixXd wanted = sandwich.of_halves();
    // Halves do not differ in numbers that no image shows, such as the aim of a lamp that is off.
    constexpr double kNothing = std::numeric_limits<double>::min();
    const VectorXd variances = (keep * wanted.topLeftCorner(count, count) * keep.transpose())
                                   .diagonal()
                                   .cwiseMax(kNothing);
    const double map_variance = std::max(mean_variance(slopes, wanted), kNothing);
    VectorXd log_squares = VectorXd::Zero(count);
    double map_log_square = 0.0;
    for (std::size_t split = 0; split < kSplits; ++split) {
        const VectorXd apart = half(split, 1).x - half(split, 0).x;
        const VectorXd squares = (keep * apart.head(count)).cwiseAbs2().cwiseQuotient(variances);
        log_squares.array() += by_word(problem, squares).array().log() / kSplits;
        map_log_square +=
            std::log(mean_variance(slopes, apart * apart.transpose()) / map_variance) / kSplits;
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
