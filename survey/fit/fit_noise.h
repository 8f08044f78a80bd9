// SPDX-License-Identifier: BSD-3-Clause
//
// The noise of a block in a fit, over its channels, as the residuals tell it:
//
//   D_ij = s_i R_ij s_j        s_i^2 = v_0 + v_1 S_i + v_2 S_i^2
//
//   S   the block's signal in a channel
//   v   read noise, shot noise and texture, of all channels alike; v_2 at least kLeastNoise squared
//   R   correlation: texture darkens all channels at once, so that their ratios, by which water and
//       veil are told, are far surer than their brightness
//
// Both come from median deviations, to which stones and their shade are no more than a few blocks:
// R_ij from those of sums and differences of the channels (R. Gnanadesikan and J. R. Kettenring,
// Biometrics 28, 1972, 81), kept positive by eigenvalues of kLeastEigenvalue and more.
//
// Blocks that are off count less: d, how far a block is off by D in its p channels together, is
// weighed by P. J. Huber's k/d beyond k (kHuber) or by J. W. Tukey's biweight, (1 - u^2)^2 for u =
// d/k under 1 and nothing beyond (kBiweight; A. E. Beaton and J. W. Tukey, Technometrics 16, 1974,
// 147). By p: of normal noise the biweight's k makes errors a twelfth larger, and 1.2 % of blocks
// lie beyond Huber's.
#pragma once

#include "image/camera_image.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace aphotic {

inline constexpr std::array<double, kChannels> kBiweight{3.44, 3.82, 4.14};
inline constexpr std::array<double, kChannels> kHuber{2.50, 2.96, 3.30};
inline constexpr double kLeastEigenvalue = 0.02;
inline constexpr double kLeastNoise = 1e-4;  // of the signal

inline constexpr double kNormal =
    1.4826;  // standard deviation of a normal over its median deviation

enum class Robust { Huber, Biweight };
// Round by round, as weights are found anew: far from the answer the biweight would take what is
// right for stones.
inline constexpr std::array kRobustRounds{
    Robust::Huber, Robust::Huber, Robust::Biweight, Robust::Biweight, Robust::Biweight};

struct Influence {
    double weight = 1.0;
    double slope = 1.0;  // of weight times how far off, the mean over directions
};

// Of a block that is off by d in so many channels.
[[nodiscard]] Influence influence_of(double d, std::size_t channels, Robust robust);

// A block's channels; NaN where it has none.
using BlockChannels = Eigen::Matrix<double, kChannels, 1>;
using ChannelMatrix = Eigen::Matrix<double, kChannels, kChannels>;

struct BlockNoise {
    std::array<double, 3> variance{};  // v_0, v_1, v_2
    ChannelMatrix correlation = ChannelMatrix::Identity();

    [[nodiscard]] double at(double signal) const {
        return variance[0] + signal * (variance[1] + signal * variance[2]);
    }
    // L^-1 of D = L L^T over the channels whose signal is finite; rows and columns of the others
    // are 0. scale: the noise's variance over that of other images.
    [[nodiscard]] ChannelMatrix whitening(const BlockChannels& signal, double scale) const;
};

struct BlockResidual {
    BlockChannels signal;    // NaN: none in this channel
    BlockChannels residual;  // at the noise of an image of scale 1
};

// Of one block at least.
[[nodiscard]] BlockNoise noise_of(const std::vector<BlockResidual>& blocks);

}  // namespace aphotic
