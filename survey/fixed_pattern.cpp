// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fixed_pattern.h"

#include "base/upper_median.h"
#include "base/words.h"

#include <fmt/format.h>
#include <Eigen/SparseCholesky>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <random>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

using Residual = std::vector<float>;

// Neighbouring places.
struct PlacePair {
    std::size_t one = 0;
    std::size_t other = 0;

    // NaN where one is unseen.
    [[nodiscard]] double difference(const Residual& residual) const {
        return static_cast<double>(residual[other]) - static_cast<double>(residual[one]);
    }
};

std::vector<PlacePair> pairs_of(std::size_t places, std::size_t across) {
    std::vector<PlacePair> pairs;
    for (std::size_t place = 0; place < places; ++place) {
        if (place % across + 1 < across) pairs.push_back({place, place + 1});
        if (place + across < places) pairs.push_back({place, place + across});
    }
    return pairs;
}

double spread_of(std::span<const Residual> residuals, const std::vector<PlacePair>& pairs) {
    std::vector<double> sizes;
    for (const PlacePair& pair : pairs) {
        for (const Residual& residual : residuals) {
            const double d = pair.difference(residual);
            if (std::isfinite(d)) sizes.push_back(std::abs(d));
        }
    }
    constexpr double kLeast = 1e-9;  // of images without any texture
    return sizes.empty() ? kLeast : std::max(kLeast, upper_median(sizes) / kMedianOfT2);
}

// D, and the sum of w about it.
struct Centre {
    double difference = 0.0;
    double weight = 0.0;
};

Centre centre_of(const VectorXd& differences, double spread) {
    constexpr int kRounds = 5;
    Centre centre;
    for (int round = 0; round < kRounds; ++round) {
        const auto off = (differences.array() - centre.difference) / spread;
        const Eigen::ArrayXd weights = 3.0 / (2.0 + off.square());
        centre.weight = weights.sum();
        centre.difference = (weights * differences.array()).sum() / centre.weight;
    }
    return centre;
}

// A sign of each image, by draw; the first draw has the images as they are.
MatrixXd random_signs(std::size_t images) {
    MatrixXd signs(static_cast<Index>(images), 1 + kDraws);
    std::mt19937 random;
    for (double& sign : signs.reshaped()) sign = (random() >> 31U) == 0 ? 1.0 : -1.0;
    signs.col(0).setOnes();
    return signs;
}

// The fields' normal equations, with a right-hand side for each draw. All have the weights of the
// images as they are.
struct Equations {
    Eigen::SparseMatrix<double> normal;
    MatrixXd wanted;
    std::vector<bool> is_seen;
};

Equations equations_of(std::span<const Residual> residuals, std::size_t across) {
    const std::size_t places = residuals.front().size();
    const auto size = static_cast<Index>(places);
    const std::vector<PlacePair> pairs = pairs_of(places, across);
    const double spread = spread_of(residuals, pairs);
    const MatrixXd signs = random_signs(residuals.size());
    Equations all{.normal{size, size},
                  .wanted = MatrixXd::Zero(size, signs.cols()),
                  .is_seen = std::vector<bool>(places)};
    Triplets entries;
    constexpr double kTie = 1e-6;  // selects one of all fields that differ by a constant
    for (Index k = 0; k < size; ++k) entries.emplace_back(k, k, kTie);
    for (const PlacePair& pair : pairs) {
        std::vector<Index> seen;
        std::vector<double> differences;
        for (std::size_t i = 0; i < residuals.size(); ++i) {
            const double d = pair.difference(residuals[i]);
            if (!std::isfinite(d)) continue;
            seen.push_back(static_cast<Index>(i));
            differences.push_back(d);
        }
        if (seen.empty()) continue;
        const VectorXd d = VectorXd::Map(differences.data(), std::ssize(differences));
        const double weight = centre_of(d, spread).weight;
        const auto one = static_cast<Index>(pair.one);
        const auto other = static_cast<Index>(pair.other);
        for (Index draw = 0; draw < signs.cols(); ++draw) {
            const VectorXd drawn = d.cwiseProduct(signs.col(draw)(seen));
            const double pull = weight * centre_of(drawn, spread).difference;
            all.wanted(one, draw) -= pull;
            all.wanted(other, draw) += pull;
        }
        entries.emplace_back(one, one, weight);
        entries.emplace_back(other, other, weight);
        entries.emplace_back(one, other, -weight);
        entries.emplace_back(other, one, -weight);
        all.is_seen[pair.one] = all.is_seen[pair.other] = true;
    }
    all.normal.setFromTriplets(entries.begin(), entries.end());
    return all;
}

}  // namespace

std::string words_of(const FixedPattern& pattern) {
    if (pattern.logarithm.empty()) return "";
    const std::string images = counted(pattern.images, "image");
    const double by_chance = 100.0 * pattern.by_chance;
    return fmt::format("a fixed pattern of {:.2g} % over {}, {} floors alone leave {:.2g} %",
                       100.0 * pattern.rms,
                       images,
                       pattern.exceeds_chance() ? "where" : "no more than chance:",
                       by_chance);
}

nlohmann::ordered_json to_json(const FixedPattern& pattern) {
    if (pattern.logarithm.empty()) return nullptr;
    return {{"images", pattern.images},
            {"rms", pattern.rms},
            {"by_chance", pattern.by_chance},
            {"exceeds_chance", pattern.exceeds_chance()}};
}

FixedPattern fixed_pattern(std::span<const std::vector<float>> residuals, std::size_t across) {
    FixedPattern pattern{.images = residuals.size()};
    if (residuals.empty()) return pattern;
    const Equations equations = equations_of(residuals, across);
    const MatrixXd fields = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(equations.normal)
                                .solve(equations.wanted);
    const auto seen = static_cast<double>(std::ranges::count(equations.is_seen, true));
    if (seen == 0.0) return pattern;
    // Unseen places are 0 in every field.
    const VectorXd means = fields.colwise().sum().transpose() / seen;
    const VectorXd squares = fields.colwise().squaredNorm().transpose() / seen - means.cwiseAbs2();
    pattern.rms = std::sqrt(squares(0));
    pattern.by_chance = std::sqrt(squares.tail(kDraws).mean());
    pattern.most_by_chance = std::sqrt(squares.tail(kDraws).maxCoeff());
    for (std::size_t k = 0; k < residuals.front().size(); ++k)
        pattern.logarithm.push_back(
            equations.is_seen[k] ? static_cast<float>(fields(static_cast<Index>(k), 0) - means(0))
                                 : std::numeric_limits<float>::quiet_NaN());
    return pattern;
}

}  // namespace aphotic
