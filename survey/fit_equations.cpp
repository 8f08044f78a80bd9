// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit_equations.h"

#include "base/non_negative_fit.h"
#include "base/parallel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFirstNoise = 0.05;
constexpr double kFirstFloor = 0.003;  // of the brightest
constexpr double kNormal = 1.4826;     // standard deviation of a normal over its median deviation

double median_of(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Deviation {
    double signal;
    double residual;  // at the noise of an image of scale 1
};

// v_0, v_1, v_2 from the median deviations of blocks of like signal.
BlockNoise noise_of(std::vector<Deviation> deviations) {
    constexpr std::size_t kLeastOfBin = 50;
    constexpr std::size_t kMostBins = 16;
    std::sort(deviations.begin(), deviations.end(), [](const auto& a, const auto& b) {
        return a.signal < b.signal;
    });
    const std::size_t bins = std::clamp<std::size_t>(deviations.size() / kLeastOfBin, 1, kMostBins);
    MatrixXd A(static_cast<Index>(bins), 3);
    VectorXd y(static_cast<Index>(bins));
    const double most = std::max(deviations.back().signal, std::numeric_limits<double>::min());
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const std::size_t from = bin * deviations.size() / bins;
        const std::size_t to = (bin + 1) * deviations.size() / bins;
        std::vector<double> sizes;
        double signal = 0.0;
        for (std::size_t i = from; i < to; ++i) {
            sizes.push_back(std::abs(deviations[i].residual));
            signal += std::max(0.0, deviations[i].signal) / static_cast<double>(to - from) / most;
        }
        const double sigma = std::max(kNormal * median_of(sizes), 1e-9 * most);
        // Each bin's own variance counts alike.
        const auto row = static_cast<Index>(bin);
        A.row(row) << 1.0, signal, signal * signal;
        A.row(row) /= sigma * sigma;
        y(row) = 1.0;
    }
    const VectorXd v = non_negative_fit(A.transpose() * A, A.transpose() * y);
    // Never none: what the fit makes dark has a weight, too.
    constexpr double kLeast = 1e-6;
    const double least = kLeast * kLeast * most * most;
    return {.variance = {std::max(v(0), least), v(1) / most, v(2) / (most * most)}};
}

}  // namespace

FitEquations::FitEquations(const FitLight& light, const FitSamples& samples, int threads)
    : light_(light), samples_(samples), threads_(threads) {
    double mean_images = 0.0;
    for (const FitImage& image : samples.images)
        mean_images += image.images / static_cast<double>(samples.images.size());
    for (const FitImage& from : samples.images) {
        Image image{.signal = VectorXd::Zero(static_cast<Index>(light.rows())),
                    .weight = VectorXd::Zero(static_cast<Index>(light.rows())),
                    .effects = Rows::Zero(static_cast<Index>(light.rows()), kEffects),
                    .noise_scale = mean_images / from.images};
        for (std::size_t row = 0; row < light.rows(); ++row) {
            if (!std::isfinite(from.signal[row])) continue;
            image.signal(static_cast<Index>(row)) = from.signal[row];
            image.weight(static_cast<Index>(row)) = 1.0;
            ++blocks_;
        }
        images_.push_back(std::move(image));
    }
    const FitPlaces& places = samples.places;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto part = [](double at, int size, std::size_t parts) {
            return std::min(parts - 1,
                            static_cast<std::size_t>(at / size * static_cast<double>(parts)));
        };
        tile_of_place_.push_back(part(places.rows[i], places.height_px, kTilesDown) * kTilesAcross +
                                 part(places.columns[i], places.width_px, kTilesAcross));
    }
}

void FitEquations::assume_noise() {
    double most = 0.0;
    for (const Image& image : images_) most = std::max(most, image.signal.maxCoeff());
    noise_ = {.variance = {std::pow(kFirstFloor * most, 2.0), 0.0, std::pow(kFirstNoise, 2.0)}};
    effects_.fill(0.0);
    for (Image& image : images_) {
        for (Index row = 0; row < image.weight.size(); ++row) {
            if (image.weight(row) <= 0.0) continue;
            image.weight(row) =
                1.0 / (image.noise_scale * noise_.at(std::max(0.0, image.signal(row))));
        }
    }
}

FitEquations::Rows FitEquations::effects_at(const FitState& state,
                                            const PathLight& light,
                                            const VectorXd& shares,
                                            const Sled& sled,
                                            VectorXd& signal) const {
    Rows parts;
    Rows pose;
    light_.parts_into(state, light, sled, parts);
    light_.slopes_into(state, light, sled, shares, {}, pose);
    signal = parts * shares;
    Rows effects = Rows::Zero(signal.size(), kEffects);
    effects.col(0) = signal;
    for (Index row = 0; row < signal.size(); row += kChannels) {
        effects(row, 1) = signal(row);
        effects(row + 2, 2) = signal(row + 2);
    }
    effects.rightCols(FitLight::kPoseColumns) = pose;
    return effects;
}

MatrixXd FitEquations::effect_covariance(const Image& image) const {
    MatrixXd root = MatrixXd::Zero(kEffects, kEffects);
    for (std::size_t k = 0; k < kEffects; ++k) {
        const auto i = static_cast<Index>(k);
        root(i, i) = std::sqrt(effects_[k] * image.noise_scale);
    }
    // Gamma^1/2 (1 + Gamma^1/2 U^T D^-1 U Gamma^1/2)^-1 Gamma^1/2 needs no inverse of Gamma.
    const MatrixXd information =
        image.effects.transpose() * image.weight.asDiagonal() * image.effects;
    const MatrixXd inner = MatrixXd::Identity(kEffects, kEffects) + root * information * root;
    return root * inner.ldlt().solve(root);
}

void FitEquations::learn_noise(const FitState& state,
                               const PathLight& light,
                               const VectorXd& shares,
                               bool estimate_effects) {
    std::vector<VectorXd> signals(images_.size());
    parallel_for(
        images_.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
            images_[i].effects =
                effects_at(state, light, shares, samples_.images[i].sled, signals[i]);
        });
    constexpr int kSweeps = 3;  // noise and effects each need the other
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        std::vector<Deviation> deviations;
        EffectVariances found{};
        std::vector<VectorXd> residuals;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const Image& image = images_[i];
            const MatrixXd covariance = effect_covariance(image);
            const VectorXd off = image.signal - signals[i];
            const VectorXd effects =
                covariance * (image.effects.transpose() * image.weight.cwiseProduct(off));
            residuals.push_back(off - image.effects * effects);
            for (std::size_t k = 0; k < kEffects; ++k) {
                const auto at = static_cast<Index>(k);
                found[k] += (effects(at) * effects(at) + covariance(at, at)) /
                            (image.noise_scale * static_cast<double>(images_.size()));
            }
            for (Index row = 0; row < off.size(); ++row) {
                if (image.weight(row) <= 0.0) continue;
                deviations.push_back(
                    {.signal = signals[i](row),
                     .residual = residuals[i](row) / std::sqrt(image.noise_scale)});
            }
        }
        if (estimate_effects) effects_ = found;
        noise_ = noise_of(std::move(deviations));
        double weights = 0.0;
        double slopes = 0.0;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            Image& image = images_[i];
            for (Index row = 0; row < image.weight.size(); ++row) {
                if (image.weight(row) <= 0.0) continue;
                const double variance =
                    image.noise_scale * noise_.at(std::max(0.0, signals[i](row)));
                const double off = std::abs(residuals[i](row)) / std::sqrt(variance);
                const double huber = off > kHuber ? kHuber / off : 1.0;
                image.weight(row) = huber / variance;
                weights += huber;
                slopes += off > kHuber ? 0.0 : 1.0;
            }
        }
        huber_factor_ = weights / std::max(slopes, 1.0);
    }
}

void FitEquations::tie_parts(const FitState& state, const VectorXd& shares) {
    tie_.setZero(shares.size(), shares.size());
    Index first = 0;
    for (const FitBeam& beam : state.beams) {
        const auto count = static_cast<Index>(beam.parts());
        const double most = shares.segment(first, count).maxCoeff();
        const double per_variance = most > 0.0 ? std::pow(kTie * most, -2.0) : 0.0;
        const Eigen::Vector2d difference(1.0, -1.0);
        for (Index m = 0; m + 1 < count && beam.kind() == FitBeamKind::Table; ++m) {
            tie_.block<2, 2>(first + m, first + m) +=
                per_variance * difference * difference.transpose();
        }
        first += count;
    }
}

FitEquations::Parts FitEquations::parts(const FitState& state, const PathLight& light) const {
    std::vector<Parts> of(images_.size());
    parallel_for(
        images_.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
            const Image& image = images_[i];
            Rows A;
            light_.parts_into(state, light, samples_.images[i].sled, A);
            const MatrixXd covariance = effect_covariance(image);
            const Rows weighted = image.weight.asDiagonal() * A;
            const VectorXd y = image.weight.cwiseProduct(image.signal);
            const MatrixXd across = image.effects.transpose() * weighted;
            const VectorXd along = image.effects.transpose() * y;
            of[i] = {.G = A.transpose() * weighted - across.transpose() * covariance * across,
                     .b = A.transpose() * y - across.transpose() * (covariance * along),
                     .squares = y.dot(image.signal) - along.dot(covariance * along)};
        });
    Parts all = of.front();
    for (std::size_t i = 1; i < of.size(); ++i) {
        all.G += of[i].G;
        all.b += of[i].b;
        all.squares += of[i].squares;
    }
    if (tie_.size() > 0) all.G += tie_;
    return all;
}

std::array<double, kChannels> FitEquations::gains(const FitState& state,
                                                  const PathLight& light) const {
    struct Sums {
        MatrixXd G;  // of green
        VectorXd b;
    };
    std::vector<Sums> of(images_.size());
    constexpr Index kGreen = 1;
    const auto of_channel = [](const auto& rows, Index channel) {
        return Rows(
            rows(Eigen::seq(channel, Eigen::last, static_cast<Index>(kChannels)), Eigen::all));
    };
    std::vector<Rows> parts(images_.size());
    parallel_for(
        images_.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
            light_.parts_into(state, light, samples_.images[i].sled, parts[i]);
            const Rows A = of_channel(parts[i], kGreen);
            const Rows weighted = of_channel(images_[i].weight, kGreen).col(0).asDiagonal() * A;
            of[i] = {.G = A.transpose() * weighted,
                     .b = weighted.transpose() * of_channel(images_[i].signal, kGreen).col(0)};
        });
    Sums all = of.front();
    for (std::size_t i = 1; i < of.size(); ++i) {
        all.G += of[i].G;
        all.b += of[i].b;
    }
    const VectorXd shares = non_negative_fit(all.G, all.b);
    std::array<double, kChannels> gains{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        double along = 0.0;
        double squares = 0.0;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const auto at = static_cast<Index>(c);
            const VectorXd signal = of_channel(parts[i], at) * shares;
            const VectorXd weight = of_channel(images_[i].weight, at).col(0);
            along += signal.dot(weight.cwiseProduct(of_channel(images_[i].signal, at).col(0)));
            squares += signal.dot(weight.cwiseProduct(signal));
        }
        gains[c] = along > 0.0 && squares > 0.0 ? along / squares : 1.0;
    }
    for (double& gain : gains) gain /= gains[kGreen];
    return gains;
}

FitEquations::Normal FitEquations::normal(const FitState& state,
                                          const PathLight& light,
                                          const VectorXd& shares,
                                          const std::vector<FitNumber>& numbers,
                                          bool has_meat) const {
    std::vector<Normal> of(images_.size());
    const auto count = static_cast<Index>(numbers.size());
    parallel_for(
        images_.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
            const Image& image = images_[i];
            const Sled& sled = samples_.images[i].sled;
            Rows parts;
            Rows slopes;
            light_.parts_into(state, light, sled, parts);
            light_.slopes_into(state, light, sled, shares, numbers, slopes);
            Rows A(parts.rows(), parts.cols() + count);
            A << parts, slopes.leftCols(count);
            const MatrixXd covariance = effect_covariance(image);
            const VectorXd off = image.signal - parts * shares;
            const VectorXd weighted_off = image.weight.cwiseProduct(off);
            const Rows weighted = image.weight.asDiagonal() * A;
            const MatrixXd across = image.effects.transpose() * weighted;
            const VectorXd effects = covariance * (image.effects.transpose() * weighted_off);
            Normal& normal = of[i];
            normal.H = A.transpose() * weighted - across.transpose() * covariance * across;
            normal.gradient = A.transpose() * weighted_off - across.transpose() * effects;
            if (!has_meat) return;
            const VectorXd left = image.weight.cwiseProduct(off - image.effects * effects);
            // D V^-1 A: what of the columns the image's own effects cannot take up.
            const Rows own = A - image.effects * (covariance * across);
            MatrixXd scores = MatrixXd::Zero(A.cols(), kTilesAcross * kTilesDown);
            for (Index row = 0; row < A.rows(); ++row) {
                if (left(row) == 0.0) continue;
                const auto tile = tile_of_place_[static_cast<std::size_t>(row) / kChannels];
                scores.col(static_cast<Index>(tile)) += left(row) * own.row(row).transpose();
            }
            // Z = A^T V^-1 U = A^T D^-1 U (1 - C U^T D^-1 U)
            const MatrixXd information =
                image.effects.transpose() * image.weight.asDiagonal() * image.effects;
            const MatrixXd Z = across.transpose() *
                               (MatrixXd::Identity(kEffects, kEffects) - covariance * information);
            VectorXd variances(static_cast<Index>(kEffects));
            for (std::size_t k = 0; k < kEffects; ++k)
                variances(static_cast<Index>(k)) = effects_[k] * image.noise_scale;
            normal.meat = scores * scores.transpose() + Z * variances.asDiagonal() * Z.transpose();
            normal.tiles =
                static_cast<std::size_t>((scores.colwise().squaredNorm().array() > 0.0).count());
        });
    Normal all = of.front();
    for (std::size_t i = 1; i < of.size(); ++i) {
        all.H += of[i].H;
        all.gradient += of[i].gradient;
        all.tiles += of[i].tiles;
        if (has_meat) all.meat += of[i].meat;
    }
    if (tie_.size() > 0) {
        const Index parts = tie_.rows();
        all.H.topLeftCorner(parts, parts) += tie_;
        all.gradient.head(parts) -= tie_ * shares;
    }
    return all;
}

MatrixXd FitEquations::normal_of(const FitState& state,
                                 const PathLight& light,
                                 const VectorXd& shares,
                                 const std::vector<FitNumber>& numbers,
                                 const Sled& sled) const {
    const auto count = static_cast<Index>(numbers.size());
    Image image;
    image.effects = effects_at(state, light, shares, sled, image.signal);
    image.weight = image.signal.unaryExpr(
        [&](double signal) { return 1.0 / noise_.at(std::max(0.0, signal)); });
    Rows parts;
    Rows slopes;
    light_.parts_into(state, light, sled, parts);
    light_.slopes_into(state, light, sled, shares, numbers, slopes);
    Rows A(parts.rows(), parts.cols() + count);
    A << parts, slopes.leftCols(count);
    const Rows weighted = image.weight.asDiagonal() * A;
    const MatrixXd across = image.effects.transpose() * weighted;
    return A.transpose() * weighted - across.transpose() * effect_covariance(image) * across;
}

FitEquations::Residual FitEquations::residual_of(std::size_t i,
                                                 const FitState& state,
                                                 const PathLight& light,
                                                 const VectorXd& shares) const {
    Image image = images_[i];
    Residual found;
    image.effects = effects_at(state, light, shares, samples_.images[i].sled, found.signal);
    const VectorXd off = image.signal - found.signal;
    const VectorXd effects =
        effect_covariance(image) * (image.effects.transpose() * image.weight.cwiseProduct(off));
    found.residual = off - image.effects * effects;
    for (Index row = 0; row < off.size(); ++row) {
        if (image.weight(row) <= 0.0)
            found.residual(row) = std::numeric_limits<double>::quiet_NaN();
    }
    for (std::size_t k = 0; k < kEffects; ++k) found.effects[k] = effects(static_cast<Index>(k));
    return found;
}

}  // namespace aphotic
