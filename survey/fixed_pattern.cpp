// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fixed_pattern.h"

#include "base/upper_median.h"
#include "base/words.h"

#include <fmt/format.h>
#include <Eigen/SparseCholesky>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <random>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

using Residual = std::vector<float>;

// use(one, other, d) for neighbouring places that are both seen.
template <typename Use>
void for_pairs(const Residual& residual, std::size_t across, const Use& use) {
    const auto pair = [&](std::size_t one, std::size_t other) {
        const double d = static_cast<double>(residual[other]) - static_cast<double>(residual[one]);
        if (std::isfinite(d)) use(static_cast<Index>(one), static_cast<Index>(other), d);
    };
    for (std::size_t place = 0; place < residual.size(); ++place) {
        if (place % across + 1 < across) pair(place, place + 1);
        if (place + across < residual.size()) pair(place, place + across);
    }
}

double spread_of(std::span<const Residual> residuals, std::size_t across) {
    std::vector<double> sizes;
    for (const Residual& residual : residuals)
        for_pairs(residual, across, [&](Index, Index, double d) { sizes.push_back(std::abs(d)); });
    constexpr double kLeast = 1e-9;  // of images without any texture
    return sizes.empty() ? kLeast : std::max(kLeast, upper_median(sizes) / kMedianOfT2);
}

// The first column has each image as it is.
MatrixXd random_signs(std::size_t images) {
    MatrixXd signs(static_cast<Index>(images), 1 + kDraws);
    std::mt19937 random;
    for (double& sign : signs.reshaped()) sign = (random() >> 31U) == 0 ? 1.0 : -1.0;
    signs.col(0).setOnes();
    return signs;
}

// The field's normal equations: a matrix, and a right-hand side for each image alone.
struct Equations {
    Eigen::SparseMatrix<double> normal;
    MatrixXd wanted;
    std::vector<bool> is_seen;
};

Equations equations_of(std::span<const Residual> residuals, std::size_t across) {
    const std::size_t places = residuals.front().size();
    const auto size = static_cast<Index>(places);
    const double spread = spread_of(residuals, across);
    Equations all{.normal{size, size},
                  .wanted = MatrixXd::Zero(size, std::ssize(residuals)),
                  .is_seen = std::vector<bool>(places)};
    Triplets entries;
    constexpr double kTie = 1e-6;  // selects one of all fields that differ by a constant
    for (Index k = 0; k < size; ++k) entries.emplace_back(k, k, kTie);
    for (Index i = 0; i < std::ssize(residuals); ++i) {
        const Residual& residual = residuals[static_cast<std::size_t>(i)];
        for_pairs(residual, across, [&](Index one, Index other, double d) {
            const double w = 3.0 / (2.0 + d * d / (spread * spread));
            for (const auto& [row, sign] : {std::pair(one, -1.0), std::pair(other, 1.0)}) {
                entries.emplace_back(row, row, w);
                all.wanted(row, i) += sign * w * d;
                all.is_seen[static_cast<std::size_t>(row)] = true;
            }
            entries.emplace_back(one, other, -w);
            entries.emplace_back(other, one, -w);
        });
    }
    all.normal.setFromTriplets(entries.begin(), entries.end());
    return all;
}

}  // namespace

std::string words_of(const FixedPattern& pattern) {
    if (pattern.logarithm.empty()) return "";
    const std::string images = counted(pattern.images, "image");
    const double by_chance = 100.0 * pattern.by_chance;
    if (!pattern.exceeds_chance())
        return fmt::format("no fixed pattern over {} beyond the {:.2g} % that floors alone leave",
                           images,
                           by_chance);
    return fmt::format("a fixed pattern of {:.2g} % over {}, where floors alone leave {:.2g} %",
                       100.0 * pattern.rms,
                       images,
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
                                .solve(equations.wanted * random_signs(residuals.size()));
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
