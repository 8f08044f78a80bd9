// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_noise.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <limits>
#include <random>

namespace aphotic::fit_noise_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-12;

// Texture of 10 % that darkens all channels, 3 % of each channel's own, on a floor of 0.2 to 1.
constexpr double kTexture = 0.1;
constexpr double kOwn = 0.03;

std::vector<BlockResidual> textured(std::size_t count, double shaded) {
    std::mt19937_64 dice(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> even(0.0, 1.0);
    std::vector<BlockResidual> blocks;
    for (std::size_t i = 0; i < count; ++i) {
        const double light = 0.2 + 0.8 * even(dice);
        const double texture = even(dice) < shaded ? -0.6 : kTexture * normal(dice);
        BlockResidual block;
        for (int c = 0; c < kChannels; ++c) {
            block.signal(c) = light * (1.0 - 0.2 * c);
            block.residual(c) = block.signal(c) * (texture + kOwn * normal(dice));
        }
        blocks.push_back(block);
    }
    return blocks;
}

// Of 20000 blocks median deviations are right to 1 %, correlations to less; of a twentieth in the
// shade medians move by a tenth.
TEST(FitNoise, IsFoundThoughATwentiethLiesInTheShade) {
    constexpr double kVariance = kTexture * kTexture + kOwn * kOwn;
    constexpr double kCorrelation = kTexture * kTexture / kVariance;
    constexpr double kChance = 0.03;
    constexpr double kShade = 0.25;
    for (const auto& [shaded, off] : {std::pair{0.0, kChance}, {0.05, kShade}}) {
        const BlockNoise noise = noise_of(textured(20000, shaded));
        for (const double signal : {0.3, 0.6, 0.9})
            EXPECT_NEAR(noise.at(signal) / (signal * signal * kVariance), 1.0, off);
        EXPECT_NEAR(noise.correlation(0, 1), kCorrelation, kChance);
        EXPECT_NEAR(noise.correlation(0, 2), kCorrelation, kChance);
        EXPECT_NEAR(noise.correlation(1, 1), 1.0, kRounding);
    }
}

// Rounding of maps that the fit's own model made would be all the noise there is.
TEST(FitNoise, IsNeverNone) {
    std::vector<BlockResidual> exact = textured(1000, 0.0);
    for (BlockResidual& block : exact) block.residual *= 1e-9;
    for (const double signal : {0.3, 0.9})
        EXPECT_NEAR(std::sqrt(noise_of(exact).at(signal)), kLeastNoise * signal, 1e-6);
}

TEST(FitNoise, WhitensWhatChannelsABlockHas) {
    BlockNoise noise{.variance = {0.01, 0.02, 0.03}};
    noise.correlation << 1.0, 0.9, 0.7, 0.9, 1.0, 0.8, 0.7, 0.8, 1.0;
    const BlockChannels signal(0.5, 1.0, 2.0);
    constexpr double kScale = 1.7;
    const BlockChannels sigma =
        signal.unaryExpr([&](double s) { return std::sqrt(kScale * noise.at(s)); });
    const ChannelMatrix D = sigma.asDiagonal() * noise.correlation * sigma.asDiagonal();
    const ChannelMatrix W = noise.whitening(signal, kScale);
    EXPECT_TRUE((W * D * W.transpose()).isIdentity(kRounding));

    // Without green: red and blue as though there were no other.
    const ChannelMatrix without = noise.whitening({0.5, kNone, 2.0}, kScale);
    EXPECT_TRUE(without.row(1).isZero(0.0));
    EXPECT_TRUE(without.col(1).isZero(0.0));
    const std::array<int, 2> red_and_blue{0, 2};
    const Eigen::Matrix2d W2 = without(red_and_blue, red_and_blue);
    const Eigen::Matrix2d D2 = D(red_and_blue, red_and_blue);
    EXPECT_TRUE((W2 * D2 * W2.transpose()).isIdentity(kRounding));
}

// A camera of one channel, and blocks without any noise at all.
TEST(FitNoise, IsFiniteOfOneChannelAndOfNoNoise) {
    std::vector<BlockResidual> blocks = textured(200, 0.0);
    for (BlockResidual& block : blocks) {
        block.signal.tail<2>().fill(kNone);
        block.residual.tail<2>().fill(kNone);
    }
    EXPECT_EQ(noise_of(blocks).correlation, ChannelMatrix::Identity());
    for (BlockResidual& block : blocks) block.residual(0) = 0.0;
    const BlockNoise none = noise_of(blocks);
    EXPECT_GT(none.at(0.0), 0.0);
    EXPECT_TRUE(none.whitening(blocks.front().signal, 1.0).allFinite());
}

// What the header says of k: draws of normal noise in p channels.
TEST(FitNoise, LosesATwelfthByTheBiweightWhateverTheChannels) {
    constexpr double kTwelfth = 1.085;
    constexpr double kBeyondHuber = 0.0124;
    constexpr int kDraws = 400000;
    constexpr double kChance = 0.004;
    std::mt19937_64 dice(2);
    std::normal_distribution<double> normal;
    for (std::size_t p = 1; p <= kChannels; ++p) {
        double slope = 0.0;
        double square = 0.0;
        double beyond = 0.0;
        for (int i = 0; i < kDraws; ++i) {
            double d2 = 0.0;
            for (std::size_t c = 0; c < p; ++c) d2 += std::pow(normal(dice), 2.0);
            const Influence biweight = influence_of(std::sqrt(d2), p, Robust::Biweight);
            slope += biweight.slope / kDraws;
            square += d2 * biweight.weight * biweight.weight / static_cast<double>(p) / kDraws;
            if (influence_of(std::sqrt(d2), p, Robust::Huber).weight < 1.0) beyond += 1.0 / kDraws;
        }
        EXPECT_NEAR(std::sqrt(square) / slope, kTwelfth, kChance) << p;
        EXPECT_NEAR(beyond, kBeyondHuber, 0.001) << p;
    }
}

}  // namespace
}  // namespace aphotic::fit_noise_test
