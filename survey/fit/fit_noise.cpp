// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_noise.h"

#include "base/non_negative_fit.h"
#include "base/upper_median.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// By the median of their sizes; these are turned about.
double deviation_of(std::vector<double>& values) {
    if (values.empty()) return 0.0;
    for (double& value : values) value = std::abs(value);
    return kNormal * upper_median(values);
}

struct Sample {
    double signal;
    double residual;
};

// v of bins of like signal, each bin's own variance counting alike.
std::array<double, 3> variance_of(std::vector<Sample> samples) {
    constexpr std::size_t kLeastOfBin = 50;
    constexpr std::size_t kMostBins = 16;
    std::ranges::sort(samples, {}, &Sample::signal);
    const std::size_t bins = std::clamp<std::size_t>(samples.size() / kLeastOfBin, 1, kMostBins);
    MatrixXd A(static_cast<Index>(bins), 3);
    const double most = std::max(samples.back().signal, std::numeric_limits<double>::min());
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const std::size_t from = bin * samples.size() / bins;
        const std::size_t to = (bin + 1) * samples.size() / bins;
        std::vector<double> residuals;
        double signal = 0.0;
        for (std::size_t i = from; i < to; ++i) {
            residuals.push_back(samples[i].residual);
            signal += samples[i].signal / static_cast<double>(to - from) / most;
        }
        const double sigma = std::max(deviation_of(residuals), 1e-9 * most);
        const auto row = static_cast<Index>(bin);
        A.row(row) << 1.0, signal, signal * signal;
        A.row(row) /= sigma * sigma;
    }
    const VectorXd ones = VectorXd::Ones(A.rows());
    const VectorXd v = non_negative_fit(A.transpose() * A, A.transpose() * ones);
    // Never none: what the fit makes dark has a weight, too, and a map by the same model as the
    // fit's is no truer than what both of them leave out.
    constexpr double kLeastDark = 1e-6;
    const double least = kLeastDark * kLeastDark * most * most;
    return {std::max(v(0), least),
            v(1) / most,
            std::max(v(2) / (most * most), kLeastNoise * kLeastNoise)};
}

// With no eigenvalue under the least, and ones in its diagonal.
ChannelMatrix kept_positive(const ChannelMatrix& R) {
    const Eigen::SelfAdjointEigenSolver<ChannelMatrix> solver(R);
    const ChannelMatrix lifted = solver.eigenvectors() *
                                 solver.eigenvalues().cwiseMax(kLeastEigenvalue).asDiagonal() *
                                 solver.eigenvectors().transpose();
    const BlockChannels scale = lifted.diagonal().cwiseSqrt().cwiseInverse();
    return scale.asDiagonal() * lifted * scale.asDiagonal();
}

ChannelMatrix correlation_of(const std::vector<BlockResidual>& blocks, const BlockNoise& noise) {
    std::vector<BlockChannels> sizes;  // by the noise, then by each channel's own
    for (const BlockResidual& block : blocks) {
        sizes.emplace_back(block.residual.cwiseQuotient(block.signal.unaryExpr(
            [&](double s) { return std::sqrt(noise.at(std::max(0.0, s))); })));
    }
    const auto deviation_along = [&](const BlockChannels& direction) {
        std::vector<double> along;
        for (const BlockChannels& size : sizes) {
            const double at = (direction.array() == 0.0).select(0.0, size).dot(direction);
            if (std::isfinite(at)) along.push_back(at);
        }
        return deviation_of(along);
    };
    BlockChannels own;
    for (int c = 0; c < kChannels; ++c) own(c) = deviation_along(BlockChannels::Unit(c));
    ChannelMatrix R = ChannelMatrix::Identity();
    for (int i = 0; i < kChannels; ++i) {
        for (int j = 0; j < i; ++j) {
            if (!(own(i) > 0.0 && own(j) > 0.0)) continue;
            const BlockChannels one = BlockChannels::Unit(i) / own(i);
            const BlockChannels other = BlockChannels::Unit(j) / own(j);
            const double sum = std::pow(deviation_along(one + other), 2.0);
            const double difference = std::pow(deviation_along(one - other), 2.0);
            if (sum + difference > 0.0) R(i, j) = R(j, i) = (sum - difference) / (sum + difference);
        }
    }
    return kept_positive(R);
}

}  // namespace

Influence influence_of(double d, std::size_t channels, Robust robust) {
    const auto p = static_cast<double>(channels);
    if (robust == Robust::Huber) {
        const double weight = std::min(1.0, kHuber[channels - 1] / std::max(d, 1e-300));
        return {.weight = weight, .slope = weight < 1.0 ? weight * (1.0 - 1.0 / p) : 1.0};
    }
    const double u2 = std::pow(d / kBiweight[channels - 1], 2.0);
    if (u2 >= 1.0) return {.weight = 0.0, .slope = 0.0};
    return {.weight = (1.0 - u2) * (1.0 - u2), .slope = (1.0 - u2) * (1.0 - u2 * (1.0 + 4.0 / p))};
}

ChannelMatrix BlockNoise::whitening(const BlockChannels& signal, double scale) const {
    // Those of none get a noise of their own, and then no row.
    const auto is_there = signal.array().isFinite();
    BlockChannels sigma = BlockChannels::Ones();
    ChannelMatrix R = correlation;
    for (int c = 0; c < kChannels; ++c) {
        if (is_there(c)) {
            sigma(c) = std::sqrt(scale * at(std::max(0.0, signal(c))));
        } else {
            R.row(c).setZero();
            R.col(c).setZero();
            R(c, c) = 1.0;
        }
    }
    ChannelMatrix W = R.llt().matrixL().solve(ChannelMatrix(sigma.cwiseInverse().asDiagonal()));
    for (int c = 0; c < kChannels; ++c)
        if (!is_there(c)) W(c, c) = 0.0;
    return W;
}

BlockNoise noise_of(const std::vector<BlockResidual>& blocks) {
    std::vector<Sample> samples;
    for (const BlockResidual& block : blocks) {
        for (int c = 0; c < kChannels; ++c) {
            if (std::isfinite(block.signal(c)))
                samples.push_back({std::max(0.0, block.signal(c)), block.residual(c)});
        }
    }
    BlockNoise noise{.variance = variance_of(std::move(samples))};
    noise.correlation = correlation_of(blocks, noise);
    return noise;
}

}  // namespace aphotic
