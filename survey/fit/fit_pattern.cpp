// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_pattern.h"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <array>
#include <cmath>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Of neighbouring places.
using Pairs = std::vector<std::array<std::size_t, 2>>;
Pairs pairs_of(const FitPlaces& places) {
    const std::size_t across = places.across();
    Pairs pairs;
    for (std::size_t place = 0; place < places.size(); ++place) {
        if (place % across + 1 < across) pairs.push_back({place, place + 1});
        if (place + across < places.size()) pairs.push_back({place, place + across});
    }
    return pairs;
}

// The field with these differences by least squares, of mean 0.
VectorXd field_of(const Pairs& pairs,
                  const VectorXd& differences,
                  const VectorXd& weights,
                  std::size_t places) {
    const auto size = static_cast<Index>(places);
    constexpr double kTie = 1e-6;  // selects one of all fields that differ by a constant
    std::vector<Eigen::Triplet<double>> entries;
    VectorXd wanted = VectorXd::Zero(size);
    for (Index k = 0; k < size; ++k) entries.emplace_back(k, k, kTie);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const auto one = static_cast<Index>(pairs[p][0]);
        const auto other = static_cast<Index>(pairs[p][1]);
        const double w = weights(static_cast<Index>(p));
        const double d = w * differences(static_cast<Index>(p));
        entries.emplace_back(one, one, w);
        entries.emplace_back(other, other, w);
        entries.emplace_back(one, other, -w);
        entries.emplace_back(other, one, -w);
        wanted(one) -= d;
        wanted(other) += d;
    }
    Eigen::SparseMatrix<double> normal(size, size);
    normal.setFromTriplets(entries.begin(), entries.end());
    VectorXd field = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(normal).solve(wanted);
    field.array() -= field.mean();
    return field;
}

}  // namespace

FitPattern pattern_of(const FitObjective& objective,
                      const FitPoint& point,
                      const FitPlaces& places) {
    const FitState state = objective.state_at(point);
    const PathLight light = objective.path_light(state);
    const Pairs pairs = pairs_of(places);
    const auto q = static_cast<Index>(objective.channels());
    const Index shown = q > 1 ? 1 : 0;  // green
    const auto count = std::ssize(pairs);
    const Eigen::MatrixXd inverse = point.texture.details.front().inverse();
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(count, q);
    Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(count, q);
    VectorXd weights = VectorXd::Zero(count);
    for (std::size_t i = 0; i < point.pose.size(); ++i) {
        const ImageView view = objective.view(point, state, light, i);
        for (Index p = 0; p < count; ++p) {
            const auto [one, other] = pairs[static_cast<std::size_t>(p)];
            const VectorXd d = view.residual.segment(static_cast<Index>(other) * q, q) -
                               view.residual.segment(static_cast<Index>(one) * q, q);
            if (!d.allFinite()) continue;
            const double w =
                (kDetailFreedom + static_cast<double>(q)) / (kDetailFreedom + d.dot(inverse * d));
            sums.row(p) += w * d.transpose();
            squares.row(p) += (w * d).cwiseAbs2().transpose();
            weights(p) += w;
        }
    }
    FitPattern pattern;
    double counted = 0.0;
    for (Index p = 0; p < count; ++p) {
        for (Index c = 0; c < q; ++c) {
            if (!(squares(p, c) > 0.0)) continue;
            pattern.whitened += sums(p, c) * sums(p, c) / squares(p, c);
            counted += 1.0;
        }
    }
    pattern.whitened /= std::max(counted, 1.0);
    // The channels of a pair are almost fully correlated.
    pattern.chance = std::sqrt(2.0 * static_cast<double>(q) / std::max(counted, 1.0));
    const VectorXd safe = weights.cwiseMax(1e-9);
    const VectorXd field =
        field_of(pairs, sums.col(shown).cwiseQuotient(safe), weights, places.size());
    pattern.rms = std::sqrt(field.squaredNorm() / static_cast<double>(field.size()));
    pattern.logarithm.assign(field.begin(), field.end());
    // Half of the difference between halves of the images, with random signs of the pairs.
    VectorXd turned = sums.col(shown);
    for (Index p = 0; p < count; ++p)
        turned(p) = std::sqrt(squares(p, shown)) * (p * 2654435761U % 1024 < 512 ? 1.0 : -1.0);
    const VectorXd by_chance = field_of(pairs, turned.cwiseQuotient(safe), weights, places.size());
    pattern.by_chance = std::sqrt(by_chance.squaredNorm() / static_cast<double>(by_chance.size()));
    return pattern;
}

}  // namespace aphotic
