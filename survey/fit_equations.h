// SPDX-License-Identifier: BSD-3-Clause
//
// The normal equations of a fit, over all of its images: of the signal y = A x + U c + e of each,
//
//   A   columns: the beams' parts (fit_light.h), then the numbers that are free
//   e   noise of a block: variance v_0 + v_1 S + v_2 S^2, found from the residuals themselves; read
//       noise, shot noise and the floor's texture
//   U c what all blocks of an image share: their level, and that of red and of blue beside it, for
//       floors are brighter here than there and of another hue, and errors of the image's own
//       altitude, pitch and roll; c is random, with a variance each, found as well where images
//       are many (Dempster, Laird and Rubin's EM)
//
// so that y has the covariance V = D + U Gamma U^T, and
//
//   A^T V^-1 A = A^T D^-1 A - A^T D^-1 U (Gamma^-1 + U^T D^-1 U)^-1 U^T D^-1 A
//
// A table's parts are tied so weakly that nothing changes where the images see them: their
// differences are random, with the standard deviation kTie of the largest share. So a beam goes on
// as it was where nobody looks.
//
// Blocks that are off by more than kHuber of their noise, as shells and stones are, count less
// (Huber's weights). The covariance of what is fitted is the sandwich
//
//   C = H^-1 ( sum over tiles s s^T + sum over images Z Gamma Z^T ) H^-1,    H = A^T V^-1 A
//
// with s = (D V^-1 A)^T D^-1 (y - A x - U c) over a tile, a part of an image within which noise may
// be correlated as it likes, and Z = A^T V^-1 U. It holds though e is none that D says
// (P. J. Huber 1967; H. White, Econometrica 48, 1980, 817).
#pragma once

#include "survey/fit_light.h"
#include "survey/fit_samples.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr double kTie = 0.3;
inline constexpr double kHuber = 2.5;
inline constexpr std::size_t kTilesAcross = 8;
inline constexpr std::size_t kTilesDown = 6;

// Level, that of red and of blue beside it, then altitude, pitch and roll.
inline constexpr std::size_t kEffects = 6;
using EffectVariances = std::array<double, kEffects>;

struct BlockNoise {
    std::array<double, 3> variance{};  // v_0, v_1, v_2

    [[nodiscard]] double at(double signal) const {
        return variance[0] + signal * (variance[1] + signal * variance[2]);
    }
};

class FitEquations {
  public:
    using Rows = FitLight::Rows;

    FitEquations(const FitLight& light, const FitSamples& samples, int threads);

    // The first noise: kFirstNoise of the signal and of the brightest, no effects.
    void assume_noise();
    // What the residuals of this solution tell. estimate_effects: let EM move the variances.
    void learn_noise(const FitState& state,
                     const PathLight& light,
                     const Eigen::VectorXd& shares,
                     bool estimate_effects);
    // From now on parts are tied; none before.
    void tie_parts(const FitState& state, const Eigen::VectorXd& shares);
    void set_effects(const EffectVariances& variances) { effects_ = variances; }
    [[nodiscard]] const EffectVariances& effects() const { return effects_; }
    [[nodiscard]] const BlockNoise& noise() const { return noise_; }

    // G of the parts, b = G's right side, and y^T V^-1 y.
    struct Parts {
        Eigen::MatrixXd G;
        Eigen::VectorXd b;
        double squares = 0.0;
    };
    [[nodiscard]] Parts parts(const FitState& state, const PathLight& light) const;

    // Each channel's gain to green's, under the shares that green has best.
    [[nodiscard]] std::array<double, kChannels> gains(const FitState& state,
                                                      const PathLight& light) const;

    // H over the parts and numbers, and the gradient A^T V^-1 (y - A x), x the parts' shares.
    struct Normal {
        Eigen::MatrixXd H;
        Eigen::VectorXd gradient;
        Eigen::MatrixXd meat;  // of the sandwich
        std::size_t tiles = 0;
    };
    [[nodiscard]] Normal normal(const FitState& state,
                                const PathLight& light,
                                const Eigen::VectorXd& shares,
                                const std::vector<FitNumber>& numbers,
                                bool has_meat) const;
    // The H that one more image at this pose would add, with noise as the others'.
    [[nodiscard]] Eigen::MatrixXd normal_of(const FitState& state,
                                            const PathLight& light,
                                            const Eigen::VectorXd& shares,
                                            const std::vector<FitNumber>& numbers,
                                            const Sled& sled) const;

    // The signal of an image, and what the fit leaves of it once its own level and pose are taken
    // out; and these.
    struct Residual {
        Eigen::VectorXd signal;
        Eigen::VectorXd residual;  // NaN where the block is left out
        std::array<double, kEffects> effects{};
    };
    [[nodiscard]] Residual residual_of(std::size_t image,
                                       const FitState& state,
                                       const PathLight& light,
                                       const Eigen::VectorXd& shares) const;

    // How much Huber's weights narrow the errors that H tells: mean weight over mean slope of the
    // influence.
    [[nodiscard]] double huber_factor() const { return huber_factor_; }
    [[nodiscard]] std::size_t blocks() const { return blocks_; }

  private:
    struct Image {
        Eigen::VectorXd signal;  // 0 where there is none
        Eigen::VectorXd weight;  // 0 where there is none
        Rows effects;            // U
        double noise_scale = 1.0;
    };
    [[nodiscard]] Rows effects_at(const FitState& state,
                                  const PathLight& light,
                                  const Eigen::VectorXd& shares,
                                  const Sled& sled,
                                  Eigen::VectorXd& signal) const;
    // (Gamma^-1 + U^T D^-1 U)^-1; of effects of no variance 0.
    [[nodiscard]] Eigen::MatrixXd effect_covariance(const Image& image) const;

    const FitLight& light_;
    const FitSamples& samples_;
    int threads_;
    std::vector<Image> images_;
    std::vector<std::size_t> tile_of_place_;
    EffectVariances effects_{};
    Eigen::MatrixXd tie_;  // what it adds to the parts' G; of no size: nothing
    BlockNoise noise_;
    double huber_factor_ = 1.0;
    std::size_t blocks_ = 0;
};

}  // namespace aphotic
