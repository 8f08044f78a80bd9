// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit_equations.h"

#include "base/non_negative_fit.h"
#include "base/parallel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFirstNoise = 0.05;
constexpr double kFirstFloor = 0.003;  // of the brightest
constexpr double kNormal = 1.4826;     // standard deviation of a normal over its median deviation

struct Influence {
    double weight = 0.0;
    double slope = 0.0;  // of size times weight
};

// Of a block that is off by this many of its noise.
Influence influence_of(double size, Robust robust) {
    if (robust == Robust::Huber)
        return size > kHuber ? Influence{.weight = kHuber / size} : Influence{1.0, 1.0};
    const double u2 = std::pow(size / kBiweight, 2.0);
    if (u2 >= 1.0) return {};
    return {.weight = (1.0 - u2) * (1.0 - u2), .slope = (1.0 - u2) * (1.0 - 5.0 * u2)};
}

// Of a block that is not left out: what no other sees has a solution all the same.
constexpr double kLeastWeight = 1e-3;

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

// a and b of each wave, by a + b: rings of like length.
struct Wave {
    int a;
    int b;
};

std::vector<Wave> waves() {
    std::vector<Wave> all;
    for (int ring = 1; ring <= kWaves; ++ring) {
        for (int a = 0; a <= ring; ++a) all.push_back({a, ring - a});
    }
    return all;
}

// The mean over each ring's waves in place of each: waves of one length vary alike.
void pool_waves(EffectVariances& variances) {
    std::size_t first = kWaveEffect;
    for (int ring = 1; ring <= kWaves; ++ring) {
        const auto count = static_cast<std::size_t>(ring) + 1;
        double mean = 0.0;
        for (std::size_t k = first; k < first + count; ++k)
            mean += variances[k] / static_cast<double>(count);
        for (std::size_t k = first; k < first + count; ++k) variances[k] = mean;
        first += count;
    }
}

template <typename Sum>
Sum added_up(const std::vector<Sum>& of, const auto& add) {
    Sum all = of.front();
    for (std::size_t i = 1; i < of.size(); ++i) add(all, of[i]);
    return all;
}

}  // namespace

FitEquations::FitEquations(const FitLight& light, const FitSamples& samples, int threads)
    : light_(light), threads_(threads) {
    double mean_images = 0.0;
    for (const FitImage& image : samples.images)
        mean_images += image.images / static_cast<double>(samples.images.size());
    for (const FitImage& from : samples.images) {
        Image image{.signal = VectorXd::Zero(static_cast<Index>(light.rows())),
                    .weight = VectorXd::Zero(static_cast<Index>(light.rows())),
                    .effects = Rows::Zero(static_cast<Index>(light.rows()), kEffects),
                    .noise_scale = mean_images / from.images,
                    .sled = from.sled};
        for (std::size_t row = 0; row < light.rows(); ++row) {
            if (!std::isfinite(from.signal[row])) continue;
            image.signal(static_cast<Index>(row)) = from.signal[row];
            image.weight(static_cast<Index>(row)) = 1.0;
            ++blocks_;
        }
        image.moved = image.signal;
        images_.push_back(std::move(image));
    }
    leave_out(0, 0);
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

void FitEquations::leave_out(std::size_t group, std::size_t groups) {
    used_.clear();
    for (std::size_t i = 0; i < images_.size(); ++i)
        if (groups == 0 || i % groups != group) used_.push_back(i);
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
        settle(image);
    }
}

void FitEquations::set_effects(const EffectVariances& variances) {
    effects_ = variances;
    for (Image& image : images_) settle(image);
}

FitEquations::Rows FitEquations::effects_at(const FitState& state,
                                            const PathLight& light,
                                            const VectorXd& shares,
                                            const Sled& sled,
                                            VectorXd& signal) const {
    Rows columns;
    light_.columns_into(state, light, sled, shares, {}, columns);
    signal = columns.rightCols<1>();
    const VectorXd of_floor = columns.rightCols<2>().col(0);
    Rows effects = Rows::Zero(signal.size(), kEffects);
    effects.col(0) = of_floor;
    for (Index row = 0; row < signal.size(); row += kChannels) {
        effects(row, 1) = of_floor(row);
        effects(row + 2, 2) = of_floor(row + 2);
    }
    effects.middleCols(kPoseEffect, FitLight::kPoseColumns) =
        columns.middleCols(shares.size(), FitLight::kPoseColumns);
    const FitPlaces& places = light_.places();
    const std::vector<Wave> all = waves();
    for (std::size_t place = 0; place < places.size(); ++place) {
        const double x = places.columns[place] / places.width_px * std::numbers::pi;
        const double y = places.rows[place] / places.height_px * std::numbers::pi;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const double wave = std::cos(all[k].a * x) * std::cos(all[k].b * y);
            for (std::size_t c = 0; c < kChannels; ++c) {
                const auto row = static_cast<Index>(kChannels * place + c);
                effects(row, static_cast<Index>(kWaveEffect + k)) = wave * of_floor(row);
            }
        }
    }
    return effects;
}

void FitEquations::settle(Image& image) const {
    VectorXd root(static_cast<Index>(kEffects));
    for (std::size_t k = 0; k < kEffects; ++k)
        root(static_cast<Index>(k)) = std::sqrt(effects_[k] * image.noise_scale);
    image.weighted_effects = image.weight.asDiagonal() * image.effects;
    // Gamma^1/2 (1 + Gamma^1/2 U^T D^-1 U Gamma^1/2)^-1 Gamma^1/2 needs no inverse of Gamma.
    const MatrixXd inner = MatrixXd::Identity(kEffects, kEffects) +
                           root.asDiagonal() *
                               MatrixXd(image.effects.transpose() * image.weighted_effects) *
                               root.asDiagonal();
    const MatrixXd gamma_root = root.asDiagonal();
    image.effect_covariance = gamma_root * inner.ldlt().solve(gamma_root);
}

VectorXd FitEquations::effects_in(const Image& image, const VectorXd& off) {
    return image.effect_covariance * (image.weighted_effects.transpose() * off);
}

// The image's effects at its pose, and all that follows from them.
void FitEquations::look_from(const FitState& state,
                             const PathLight& light,
                             const VectorXd& shares,
                             Image& image,
                             VectorXd& signal) const {
    image.effects = effects_at(state, light, shares, image.sled, signal);
    const Eigen::Map<const Eigen::Vector3d> back(image.back.data());
    image.moved = image.signal - image.effects.middleCols<3>(kPoseEffect) * back;
    settle(image);
}

void FitEquations::move_pose(const VectorXd& effects, Image& image) {
    const std::array<double*, FitLight::kPoseColumns> pose{
        &image.sled.altitude_m, &image.sled.pitch_rad, &image.sled.roll_rad};
    for (std::size_t q = 0; q < pose.size(); ++q) {
        const double move = image.back[q] + effects(static_cast<Index>(kPoseEffect + q));
        *pose[q] += move;
        image.back[q] -= move;
    }
}

void FitEquations::learn_effects(const std::vector<VectorXd>& off) {
    EffectVariances found{};
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const VectorXd effects = effects_in(images_[i], off[i]);
        const VectorXd variances = images_[i].effect_covariance.diagonal();
        for (std::size_t k = 0; k < kEffects; ++k) {
            const auto at = static_cast<Index>(k);
            found[k] += (effects(at) * effects(at) + variances(at)) /
                        (images_[i].noise_scale * static_cast<double>(images_.size()));
        }
    }
    pool_waves(found);
    for (std::size_t k = 0; k < kEffects; ++k) {
        const bool is_of_pose = k >= kPoseEffect && k < kWaveEffect;
        if (!is_of_pose) effects_[k] = found[k];
    }
}

void FitEquations::learn_noise(const FitState& state,
                               const PathLight& light,
                               const VectorXd& shares,
                               Robust robust,
                               bool estimate_effects) {
    std::vector<VectorXd> signals(images_.size());
    std::vector<VectorXd> off(images_.size());
    parallel_for(
        images_.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
            Image& image = images_[i];
            look_from(state, light, shares, image, signals[i]);
            const VectorXd effects = effects_in(image, image.moved - signals[i]);
            move_pose(effects, image);
            look_from(state, light, shares, image, signals[i]);
            off[i] = image.moved - signals[i];
        });
    constexpr int kSweeps = 3;  // noise and effects each need the other
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        std::vector<Deviation> deviations;
        std::vector<VectorXd> residuals;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const Image& image = images_[i];
            residuals.push_back(off[i] - image.effects * effects_in(image, off[i]));
            for (Index row = 0; row < off[i].size(); ++row) {
                if (image.weight(row) <= 0.0) continue;
                deviations.push_back(
                    {.signal = signals[i](row),
                     .residual = residuals[i](row) / std::sqrt(image.noise_scale)});
            }
        }
        if (estimate_effects) learn_effects(off);
        noise_ = noise_of(std::move(deviations));
        double weights = 0.0;
        double slopes = 0.0;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            Image& image = images_[i];
            for (Index row = 0; row < image.weight.size(); ++row) {
                if (image.weight(row) <= 0.0) continue;
                const double variance =
                    image.noise_scale * noise_.at(std::max(0.0, signals[i](row)));
                const double size = std::abs(residuals[i](row)) / std::sqrt(variance);
                const Influence influence = influence_of(size, robust);
                image.weight(row) = std::max(influence.weight, kLeastWeight) / variance;
                weights += influence.weight;
                slopes += influence.slope;
            }
            settle(image);
        }
        weights_factor_ = weights / std::max(slopes, 1.0);
    }
}

void FitEquations::tie_parts(const FitState& state, const VectorXd& shares) {
    tie_.setZero(shares.size(), shares.size());
    Index first = 0;
    for (const FitBeam& beam : state.beams) {
        const auto count = static_cast<Index>(beam.parts());
        const double most = shares.segment(first, count).maxCoeff();
        const auto tie = [&](const auto& difference, double deviation) {
            constexpr auto kSize = std::remove_cvref_t<decltype(difference)>::SizeAtCompileTime;
            for (Index m = first; m + kSize <= first + count; ++m) {
                tie_.template block<kSize, kSize>(m, m) +=
                    difference * difference.transpose() / std::pow(deviation * most, 2.0);
            }
        };
        if (beam.kind() == FitBeamKind::Table && most > 0.0) {
            tie(Eigen::Vector2d(1.0, -1.0), kTie);
            tie(Eigen::Vector3d(1.0, -2.0, 1.0), kBend);
        }
        first += count;
    }
}

MatrixXd FitEquations::information(const Image& image, const Rows& A) {
    const Rows weighted = image.weight.asDiagonal() * A;
    const MatrixXd across = image.weighted_effects.transpose() * A;
    return A.transpose() * weighted - across.transpose() * image.effect_covariance * across;
}

FitEquations::Parts FitEquations::parts(const FitState& state, const PathLight& light) const {
    std::vector<Parts> of(used_.size());
    parallel_for(used_.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
        const Image& image = images_[used_[i]];
        Rows A;
        light_.parts_into(state, light, image.sled, A);
        // V^-1 y
        const VectorXd y = image.weight.cwiseProduct(image.moved) -
                           image.weighted_effects * effects_in(image, image.moved);
        of[i] = {
            .G = information(image, A), .b = A.transpose() * y, .squares = y.dot(image.signal)};
    });
    Parts all = added_up(of, [](Parts& sum, const Parts& one) {
        sum.G += one.G;
        sum.b += one.b;
        sum.squares += one.squares;
    });
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
            light_.parts_into(state, light, images_[i].sled, parts[i]);
            const Rows A = of_channel(parts[i], kGreen);
            const Rows weighted = of_channel(images_[i].weight, kGreen).col(0).asDiagonal() * A;
            of[i] = {.G = A.transpose() * weighted,
                     .b = weighted.transpose() * of_channel(images_[i].signal, kGreen).col(0)};
        });
    const Sums all = added_up(of, [](Sums& sum, const Sums& one) {
        sum.G += one.G;
        sum.b += one.b;
    });
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

FitEquations::Rows FitEquations::columns_at(const FitState& state,
                                            const PathLight& light,
                                            const VectorXd& shares,
                                            const std::vector<FitNumber>& numbers,
                                            const Sled& sled) const {
    Rows all;
    light_.columns_into(state, light, sled, shares, numbers, all);
    return all.leftCols(shares.size() + static_cast<Index>(numbers.size()));
}

FitEquations::Normal FitEquations::normal(const FitState& state,
                                          const PathLight& light,
                                          const VectorXd& shares,
                                          const std::vector<FitNumber>& numbers,
                                          bool has_meat) const {
    std::vector<Normal> of(used_.size());
    parallel_for(used_.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
        const Image& image = images_[used_[i]];
        const Rows A = columns_at(state, light, shares, numbers, image.sled);
        const VectorXd off = image.moved - A.leftCols(shares.size()) * shares;
        // D^-1 e
        const VectorXd left =
            image.weight.cwiseProduct(off) - image.weighted_effects * effects_in(image, off);
        Normal& normal = of[i];
        normal.H = information(image, A);
        normal.gradient = A.transpose() * left;
        if (has_meat) add_meat(image, A, left, normal);
    });
    Normal all = added_up(of, [&](Normal& sum, const Normal& one) {
        sum.H += one.H;
        sum.gradient += one.gradient;
        sum.tiles += one.tiles;
        if (has_meat) sum.meat += one.meat;
    });
    if (tie_.size() > 0) {
        const Index parts = tie_.rows();
        all.H.topLeftCorner(parts, parts) += tie_;
        all.gradient.head(parts) -= tie_ * shares;
    }
    return all;
}

void FitEquations::add_meat(const Image& image,
                            const Rows& A,
                            const VectorXd& left,
                            Normal& normal) const {
    const MatrixXd& C = image.effect_covariance;
    const MatrixXd across = image.weighted_effects.transpose() * A;
    // D V^-1 A: what of the columns the image's own effects cannot take up.
    const Rows own = A - image.effects * (C * across);
    MatrixXd scores = MatrixXd::Zero(A.cols(), kTilesAcross * kTilesDown);
    for (Index row = 0; row < A.rows(); ++row) {
        if (left(row) == 0.0) continue;
        const auto tile = tile_of_place_[static_cast<std::size_t>(row) / kChannels];
        scores.col(static_cast<Index>(tile)) += left(row) * own.row(row).transpose();
    }
    // Z = A^T V^-1 U = A^T D^-1 U (1 - C U^T D^-1 U)
    const MatrixXd Z =
        across.transpose() * (MatrixXd::Identity(kEffects, kEffects) -
                              C * MatrixXd(image.effects.transpose() * image.weighted_effects));
    VectorXd variances(static_cast<Index>(kEffects));
    for (std::size_t k = 0; k < kEffects; ++k)
        variances(static_cast<Index>(k)) = effects_[k] * image.noise_scale;
    normal.meat = scores * scores.transpose() + Z * variances.asDiagonal() * Z.transpose();
    normal.tiles = static_cast<std::size_t>((scores.colwise().squaredNorm().array() > 0.0).count());
}

MatrixXd FitEquations::normal_of(const FitState& state,
                                 const PathLight& light,
                                 const VectorXd& shares,
                                 const std::vector<FitNumber>& numbers,
                                 const Sled& sled) const {
    Image image;
    image.effects = effects_at(state, light, shares, sled, image.signal);
    image.weight = image.signal.unaryExpr(
        [&](double signal) { return 1.0 / noise_.at(std::max(0.0, signal)); });
    settle(image);
    return information(image, columns_at(state, light, shares, numbers, sled));
}

FitEquations::Residual FitEquations::residual_of(std::size_t i,
                                                 const FitState& state,
                                                 const PathLight& light,
                                                 const VectorXd& shares) const {
    Image image = images_[i];
    Residual found;
    look_from(state, light, shares, image, found.signal);
    const VectorXd off = image.moved - found.signal;
    const VectorXd effects = effects_in(image, off);
    found.residual = off - image.effects * effects;
    for (Index row = 0; row < off.size(); ++row) {
        if (image.weight(row) <= 0.0)
            found.residual(row) = std::numeric_limits<double>::quiet_NaN();
    }
    std::copy(effects.begin(), effects.end(), found.effects.begin());
    return found;
}

}  // namespace aphotic
