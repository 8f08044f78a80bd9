// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_equations.h"

#include "base/non_negative_fit.h"
#include "base/parallel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <iterator>
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

// Of a block that is not left out: what no other sees has a solution all the same.
constexpr double kLeastWeight = 1e-3;

// By place; by a + b, rings of waves of like length, then by a.
FitLight::Rows waves_at(const FitPlaces& places) {
    FitLight::Rows waves(static_cast<Index>(places.size()),
                         static_cast<Index>(kEffects - kWaveEffect));
    for (std::size_t place = 0; place < places.size(); ++place) {
        const double x = places.columns[place] / places.width_px * std::numbers::pi;
        const double y = places.rows[place] / places.height_px * std::numbers::pi;
        Index column = 0;
        for (int ring = 1; ring <= kWaves; ++ring) {
            for (int a = 0; a <= ring; ++a) {
                waves(static_cast<Index>(place), column++) =
                    std::cos(a * x) * std::cos((ring - a) * y);
            }
        }
    }
    return waves;
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

// X^T X.
MatrixXd squared(const FitLight::Rows& X) {
    MatrixXd all = MatrixXd::Zero(X.cols(), X.cols());
    all.selfadjointView<Eigen::Lower>().rankUpdate(X.transpose());
    return all.selfadjointView<Eigen::Lower>();
}

// work(image, its number).
template <typename Images, typename Work>
void for_each_image(Images& images, int threads, const Work& work) {
    parallel_for(images.size(), static_cast<std::size_t>(threads), [&](std::size_t i, std::size_t) {
        work(images[i], i);
    });
}

template <typename Sum>
Sum added_up(const std::vector<Sum>& of, const auto& add) {
    Sum all = of.front();
    for (std::size_t i = 1; i < of.size(); ++i) add(all, of[i]);
    return all;
}

// By which differences of a beam's parts are measured: each the least of those up to it, from the
// axis on.
VectorXd sizes_for_ties(const VectorXd& shares) {
    const double most = shares.maxCoeff();
    VectorXd sizes(shares.size());
    double least = most;
    for (Index m = 0; m < shares.size(); ++m) {
        least = std::min(least, shares(m));
        sizes(m) = std::max(kDimmestTie * most, least);
    }
    return sizes;
}

}  // namespace

bool FitEquations::Image::has(Index row) const {
    const auto c = row % kChannels;
    return whitening[static_cast<std::size_t>(row / kChannels)](c, c) > 0.0;
}

BlockChannels FitEquations::Image::block(const VectorXd& of, std::size_t place) const {
    const Index row = kChannels * static_cast<Index>(place);
    BlockChannels values = of.segment<kChannels>(row);
    for (Index c = 0; c < kChannels; ++c)
        if (!has(row + c)) values(c) = std::numeric_limits<double>::quiet_NaN();
    return values;
}

FitEquations::Rows FitEquations::Image::white(Rows columns) const {
    for (std::size_t place = 0; place < whitening.size(); ++place) {
        auto block = columns.middleRows<kChannels>(kChannels * static_cast<Index>(place));
        block = (whitening[place] * block).eval();
    }
    return columns;
}

VectorXd FitEquations::Image::effects_in(const VectorXd& off) const {
    return effect_covariance * (white_effects.transpose() * white(off));
}

VectorXd FitEquations::Image::white_rest(const VectorXd& off) const {
    const VectorXd all = white(off);
    return all - white_effects * (effect_covariance * (white_effects.transpose() * all));
}

FitEquations::FitEquations(const FitLight& light, const FitSamples& samples, int threads)
    : light_(&light), threads_(threads), waves_(waves_at(samples.places)) {
    double mean_images = 0.0;
    for (const FitImage& image : samples.images)
        mean_images += image.images / static_cast<double>(samples.images.size());
    for (const FitImage& from : samples.images) {
        Image image{
            .signal = VectorXd::Zero(static_cast<Index>(light.rows())),
            .whitening = std::vector<ChannelMatrix>(samples.places.size(), ChannelMatrix::Zero()),
            .effects = Rows::Zero(static_cast<Index>(light.rows()), kEffects),
            .noise_scale = mean_images / from.images,
            .sled = from.sled};
        for (std::size_t row = 0; row < light.rows(); ++row) {
            if (!std::isfinite(from.signal[row])) continue;
            image.signal(static_cast<Index>(row)) = from.signal[row];
            image.whitening[row / kChannels].diagonal()(static_cast<Index>(row % kChannels)) = 1.0;
            ++blocks_;
        }
        image.moved = image.signal;
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
    for_each_image(images_, threads_, [&](Image& image, std::size_t) {
        for (std::size_t place = 0; place < image.whitening.size(); ++place) {
            image.whitening[place] =
                noise_.whitening(image.block(image.signal, place), image.noise_scale);
        }
        settle(image);
    });
}

void FitEquations::set_effects(const EffectVariances& variances) {
    effects_ = variances;
    for_each_image(images_, threads_, [&](Image& image, std::size_t) { settle(image); });
}

void FitEquations::start_effects(const FitState& state,
                                 const PathLight& light,
                                 const VectorXd& shares,
                                 const EffectVariances& most) {
    constexpr double kRoom = 4.0;  // the search without effects has made up for some of them
    if (std::ranges::count(most, 0.0) == std::ssize(most)) return;  // as they are
    learn_noise(state, light, shares, Robust::Huber, false);
    set_effects(most);
    std::vector<VectorXd> off(images_.size());
    for_each_image(images_, threads_, [&](Image& image, std::size_t i) {
        VectorXd signal;
        look_from(state, light, shares, image, signal);
        off[i] = image.moved - signal;
    });
    learn_effects(off);  // but for the pose's, which stay
    EffectVariances found = effects_;
    for (std::size_t k = 0; k < kEffects; ++k) found[k] = std::min(most[k], kRoom * found[k]);
    set_effects(found);
}

FitEquations::Rows FitEquations::effects_at(const FitState& state,
                                            const PathLight& light,
                                            const VectorXd& shares,
                                            const Sled& sled,
                                            VectorXd& signal) const {
    Rows columns;
    light_->columns_into(state, light, sled, shares, {}, columns);
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
    for (Index row = 0; row < signal.size(); ++row)
        effects.row(row).tail(waves_.cols()) = of_floor(row) * waves_.row(row / kChannels);
    return effects;
}

void FitEquations::settle(Image& image) const {
    VectorXd root(static_cast<Index>(kEffects));
    for (std::size_t k = 0; k < kEffects; ++k)
        root(static_cast<Index>(k)) = std::sqrt(effects_[k] * image.noise_scale);
    image.white_effects = image.white(image.effects);
    // Gamma^1/2 (1 + Gamma^1/2 U^T D^-1 U Gamma^1/2)^-1 Gamma^1/2 needs no inverse of Gamma.
    const MatrixXd inner = MatrixXd::Identity(kEffects, kEffects) +
                           root.asDiagonal() * squared(image.white_effects) * root.asDiagonal();
    const MatrixXd gamma_root = root.asDiagonal();
    image.effect_covariance = gamma_root * inner.ldlt().solve(gamma_root);
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

void FitEquations::move_pose(const VectorXd& effects, Image& image) const {
    const std::array<double*, FitLight::kPoseColumns> pose{
        &image.sled.altitude_m, &image.sled.pitch_rad, &image.sled.roll_rad};
    for (std::size_t q = 0; q < pose.size(); ++q) {
        const double most = kMostMove * std::sqrt(effects_[kPoseEffect + q] * image.noise_scale);
        const double from_navigation =
            std::clamp(effects(static_cast<Index>(kPoseEffect + q)), -most, most);
        const double move = image.back[q] + from_navigation;
        *pose[q] += move;
        image.back[q] -= move;
    }
}

void FitEquations::learn_effects(const std::vector<VectorXd>& off) {
    // Of the images' levels and hues the beam's scale takes up one degree of freedom, the water
    // one.
    constexpr double kTaken = 2.0;
    const auto count = static_cast<double>(images_.size());
    VectorXd factor = VectorXd::Ones(kEffects);
    factor.head(kPoseEffect).fill(count / std::max(1.0, count - kTaken));  // at least one is left
    std::vector<VectorXd> squares(images_.size());
    for_each_image(images_, threads_, [&](const Image& image, std::size_t i) {
        squares[i] = factor.cwiseProduct(image.effects_in(off[i]).cwiseAbs2()) +
                     image.effect_covariance.diagonal();
        squares[i] /= image.noise_scale * count;
    });
    const VectorXd all = added_up(squares, [](VectorXd& sum, const VectorXd& one) { sum += one; });
    EffectVariances found{};
    std::ranges::copy(all, found.begin());
    pool_waves(found);
    for (std::size_t k = 0; k < kEffects; ++k) {
        const bool is_of_pose = k >= kPoseEffect && k < kWaveEffect;
        if (!is_of_pose) effects_[k] = std::min(found[k], kMostEffect * kMostEffect);
    }
}

// The weights that an image's residuals have by the noise as it is now, and what they sum to.
FitEquations::Influences FitEquations::weigh(const VectorXd& signals,
                                             const VectorXd& residuals,
                                             Robust robust,
                                             Image& image) const {
    Influences all;
    for (std::size_t place = 0; place < image.whitening.size(); ++place) {
        const BlockChannels signal = image.block(signals, place);
        const auto channels = static_cast<std::size_t>(signal.array().isFinite().count());
        if (channels == 0) continue;
        const ChannelMatrix W = noise_.whitening(signal, image.noise_scale);
        const double d =
            (W * residuals.segment<kChannels>(kChannels * static_cast<Index>(place))).norm();
        const Influence influence = influence_of(d, channels, robust);
        image.whitening[place] = std::sqrt(std::max(influence.weight, kLeastWeight)) * W;
        all.weights += static_cast<double>(channels) * influence.weight;
        all.slopes += static_cast<double>(channels) * influence.slope;
    }
    settle(image);
    return all;
}

void FitEquations::learn_noise(const FitState& state,
                               const PathLight& light,
                               const VectorXd& shares,
                               Robust robust,
                               bool estimate_effects) {
    std::vector<VectorXd> signals(images_.size());
    std::vector<VectorXd> off(images_.size());
    for_each_image(images_, threads_, [&](Image& image, std::size_t i) {
        look_from(state, light, shares, image, signals[i]);
        const VectorXd effects = image.effects_in(image.moved - signals[i]);
        move_pose(effects, image);
        look_from(state, light, shares, image, signals[i]);
        off[i] = image.moved - signals[i];
    });
    constexpr int kSweeps = 3;  // noise and effects each need the other
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        const std::size_t places = light_->places().size();
        std::vector<VectorXd> residuals(images_.size());
        std::vector<BlockResidual> blocks(images_.size() * places);
        for_each_image(images_, threads_, [&](const Image& image, std::size_t i) {
            residuals[i] = off[i] - image.effects * image.effects_in(off[i]);
            const double scale = std::sqrt(image.noise_scale);
            for (std::size_t place = 0; place < places; ++place) {
                blocks[i * places + place] = {.signal = image.block(signals[i], place),
                                              .residual = image.block(residuals[i], place) / scale};
            }
        });
        if (estimate_effects) learn_effects(off);
        noise_ = noise_of(blocks);
        std::vector<Influences> of(images_.size());
        for_each_image(images_, threads_, [&](Image& image, std::size_t i) {
            of[i] = weigh(signals[i], residuals[i], robust, image);
        });
        const Influences all = added_up(of, [](Influences& sum, const Influences& one) {
            sum.weights += one.weights;
            sum.slopes += one.slopes;
        });
        weights_factor_ = all.weights / std::max(all.slopes, 1.0);
    }
}

void FitEquations::tie_parts(const FitState& state, const VectorXd& shares) {
    tie_.setZero(shares.size(), shares.size());
    Index first = 0;
    for (const FitBeam& beam : state.beams) {
        const auto count = static_cast<Index>(beam.parts());
        const VectorXd sizes = sizes_for_ties(shares.segment(first, count));
        const auto tie = [&](const auto& difference, double deviation) {
            constexpr auto kSize = std::remove_cvref_t<decltype(difference)>::SizeAtCompileTime;
            for (Index m = 0; m + kSize <= count; ++m) {
                tie_.template block<kSize, kSize>(first + m, first + m) +=
                    difference * difference.transpose() / std::pow(deviation * sizes(m), 2.0);
            }
        };
        if (beam.kind() == FitBeamKind::Table && sizes(0) > 0.0) {
            tie(Eigen::Vector2d(1.0, -1.0), kTie);
            tie(Eigen::Vector3d(1.0, -2.0, 1.0), kBend);
        }
        first += count;
    }
}

void FitEquations::untie() {
    tie_.resize(0, 0);
}

MatrixXd FitEquations::information(const Image& image, const Rows& white) {
    const MatrixXd across = image.white_effects.transpose() * white;
    return squared(white) - across.transpose() * image.effect_covariance * across;
}

FitEquations::Parts FitEquations::parts(const FitState& state, const PathLight& light) const {
    std::vector<Parts> of(images_.size());
    for_each_image(images_, threads_, [&](const Image& image, std::size_t i) {
        Rows A;
        light_->parts_into(state, light, image.sled, A);
        const Rows white = image.white(std::move(A));
        const VectorXd rest = image.white_rest(image.moved);
        of[i] = {.G = information(image, white),
                 .b = white.transpose() * rest,
                 .squares = rest.dot(image.white(image.moved).col(0))};
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
    constexpr Index kGreen = 1;
    const auto of_channel = [](const auto& rows, Index channel) {
        return Rows(
            rows(Eigen::seq(channel, Eigen::last, static_cast<Index>(kChannels)), Eigen::all));
    };
    struct Sums {
        MatrixXd G;  // of green
        VectorXd b;
    };
    std::vector<Sums> of(images_.size());
    std::vector<Rows> parts(images_.size());  // white, as yet channel by channel
    std::vector<Rows> signals(images_.size());
    for_each_image(images_, threads_, [&](const Image& image, std::size_t i) {
        light_->parts_into(state, light, image.sled, parts[i]);
        parts[i] = image.white(std::move(parts[i]));
        signals[i] = image.white(image.signal);
        const Rows A = of_channel(parts[i], kGreen);
        of[i] = {.G = squared(A), .b = A.transpose() * of_channel(signals[i], kGreen).col(0)};
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
            const VectorXd signal = of_channel(parts[i], static_cast<Index>(c)) * shares;
            along += signal.dot(of_channel(signals[i], static_cast<Index>(c)).col(0));
            squares += signal.squaredNorm();
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
    light_->columns_into(state, light, sled, shares, numbers, all);
    return all.leftCols(shares.size() + static_cast<Index>(numbers.size()));
}

FitEquations::Normal FitEquations::normal(const FitState& state,
                                          const PathLight& light,
                                          const VectorXd& shares,
                                          const std::vector<FitNumber>& numbers,
                                          bool has_meat) const {
    std::vector<Normal> of(images_.size());
    for_each_image(images_, threads_, [&](const Image& image, std::size_t i) {
        Rows A = columns_at(state, light, shares, numbers, image.sled);
        const VectorXd off = image.moved - A.leftCols(shares.size()) * shares;
        const VectorXd left = image.white_rest(off);
        const Rows white = image.white(std::move(A));
        Normal& normal = of[i];
        normal.H = information(image, white);
        normal.gradient = white.transpose() * left;
        if (has_meat) add_meat(image, white, left, normal);
    });
    Normal all = added_up(of, [&](Normal& sum, const Normal& one) {
        sum.H += one.H;
        sum.gradient += one.gradient;
        sum.tiles += one.tiles;
        if (has_meat) sum.meat += one.meat;
    });
    add_tie(shares, all);
    return all;
}

void FitEquations::add_tie(const VectorXd& shares, Normal& normal) const {
    if (tie_.size() == 0) return;
    const Index parts = tie_.rows();
    normal.H.topLeftCorner(parts, parts) += tie_;
    if (normal.meat.size() > 0) normal.meat.topLeftCorner(parts, parts) += tie_;
    normal.gradient.head(parts) -= tie_ * shares;
}

void FitEquations::add_meat(const Image& image,
                            const Rows& white,
                            const VectorXd& left,
                            Normal& normal) const {
    const MatrixXd& C = image.effect_covariance;
    const MatrixXd across = image.white_effects.transpose() * white;
    // W D V^-1 A: what of the columns the image's own effects cannot take up.
    const Rows own = white - image.white_effects * (C * across);
    MatrixXd scores = MatrixXd::Zero(white.cols(), kTilesAcross * kTilesDown);
    for (Index row = 0; row < white.rows(); ++row) {
        if (left(row) == 0.0) continue;
        const auto tile = tile_of_place_[static_cast<std::size_t>(row) / kChannels];
        scores.col(static_cast<Index>(tile)) += left(row) * own.row(row).transpose();
    }
    // Z = A^T V^-1 U = A^T D^-1 U (1 - C U^T D^-1 U)
    const MatrixXd Z = across.transpose() *
                       (MatrixXd::Identity(kEffects, kEffects) - C * squared(image.white_effects));
    VectorXd variances(static_cast<Index>(kEffects));
    for (std::size_t k = 0; k < kEffects; ++k)
        variances(static_cast<Index>(k)) = effects_[k] * image.noise_scale;
    normal.meat = weights_factor_ * weights_factor_ * scores * scores.transpose() +
                  Z * variances.asDiagonal() * Z.transpose();
    normal.tiles = static_cast<std::size_t>((scores.colwise().squaredNorm().array() > 0.0).count());
}

MatrixXd FitEquations::normal_of(const FitState& state,
                                 const PathLight& light,
                                 const VectorXd& shares,
                                 const std::vector<FitNumber>& numbers,
                                 const Sled& sled) const {
    Image image;
    image.effects = effects_at(state, light, shares, sled, image.signal);
    for (std::size_t place = 0; place < light_->places().size(); ++place) {
        const auto row = static_cast<Index>(kChannels * place);
        image.whitening.push_back(noise_.whitening(image.signal.segment<kChannels>(row), 1.0));
    }
    settle(image);
    return information(image, image.white(columns_at(state, light, shares, numbers, sled)));
}

FitEquations::Residual FitEquations::residual_of(std::size_t i,
                                                 const FitState& state,
                                                 const PathLight& light,
                                                 const VectorXd& shares) const {
    Image image = images_[i];
    Residual found;
    look_from(state, light, shares, image, found.signal);
    const VectorXd off = image.moved - found.signal;
    const VectorXd effects = image.effects_in(off);
    found.residual = off - image.effects * effects;
    for (Index row = 0; row < off.size(); ++row) {
        if (!image.has(row)) found.residual(row) = std::numeric_limits<double>::quiet_NaN();
    }
    std::copy(effects.begin(), effects.end(), found.effects.begin());
    return found;
}

}  // namespace aphotic
