// SPDX-License-Identifier: BSD-3-Clause
//
// The normal equations of a fit, over all of its images: of the signal y = A x + U c + e of each,
//
//   A   columns: the beams' parts (fit_light.h), then the numbers that are free
//   e   noise of a block: variance v_0 + v_1 S + v_2 S^2, found from the residuals themselves; read
//       noise, shot noise and the floor's texture
//   U c what blocks of an image share: the floor's level, and that of red and of blue beside it,
//       for floors are brighter here than there and of another hue, and its brightness across the
//       image, for its texture has waves as long as an image: cos(a pi x) cos(b pi y), a + b from 1
//       to kWaves, x and y from 0 to 1, all of the floor's light and not of the veil before it; and
//       errors of the image's own altitude, pitch and roll. c is random, with a variance each: of
//       the pose as the instruments have it, of the floor found where images are many, one for all
//       waves of the same a + b (Dempster, Laird and Rubin's EM)
//
// Poses go into the light as no straight line: each image's is moved to where its light tells it,
// round by round, and what the navigation says becomes the mean of what is left of it in c.
//
// so that y has the covariance V = D + U Gamma U^T, and
//
//   A^T V^-1 A = A^T D^-1 A - A^T D^-1 U (Gamma^-1 + U^T D^-1 U)^-1 U^T D^-1 A
//
// A table's parts are tied so weakly that little changes where the images see them: their
// differences are random, with the standard deviation kTie of the largest share, and so are the
// differences of these, with kBend. So a beam goes on as it was where nobody looks, and where few
// do it does not swing between parts that make up for each other.
//
// Blocks that are off count less, those by more than kBiweight of their noise nothing: on rough
// floors stones shade what is behind them, where the light is no flat floor's. The weight is J. W.
// Tukey's biweight, (1 - u^2)^2 for u under 1, u = e/(kBiweight sigma) (A. E. Beaton and J. W.
// Tukey, Technometrics 16, 1974, 147); of normal noise errors are a twelfth larger for it. Far from
// the rig it would take what is right for stones, so the first rounds weigh by Huber's kHuber sigma
// / |e|, which forgets nothing. The covariance of what is fitted is the sandwich
//
//   C = f^2 H^-1 ( sum over tiles s s^T + sum over images Z Gamma Z^T ) H^-1,    H = A^T V^-1 A
//
// f: mean weight over mean slope of the influence e w(e), by which weights that move with the fit
// widen it (P. J. Huber, Robust Statistics, 1981, 6.5).
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
inline constexpr double kBend = 0.1;
inline constexpr double kBiweight = 3.44;
inline constexpr double kHuber = 2.5;
enum class Robust { Huber, Biweight };
inline constexpr std::size_t kTilesAcross = 8;
inline constexpr std::size_t kTilesDown = 6;

// Level, that of red and of blue beside it, then altitude, pitch and roll, then the waves.
inline constexpr int kWaves = 5;
inline constexpr std::size_t kPoseEffect = 3;  // the first of the pose's
inline constexpr std::size_t kWaveEffect = 6;  // and of the waves'
inline constexpr std::size_t kEffects = kWaveEffect + (kWaves + 1) * (kWaves + 2) / 2 - 1;
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
                     Robust robust,
                     bool estimate_effects);
    // From now on without every image whose number leaves this one over `groups`; 0 groups: with
    // all.
    void leave_out(std::size_t group, std::size_t groups);
    // From now on parts are tied; none before.
    void tie_parts(const FitState& state, const Eigen::VectorXd& shares);
    void set_effects(const EffectVariances& variances);
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

    // f.
    [[nodiscard]] double weights_factor() const { return weights_factor_; }
    [[nodiscard]] std::size_t blocks() const { return blocks_; }

  private:
    struct Image {
        Eigen::VectorXd signal;  // 0 where there is none
        Eigen::VectorXd weight;  // 0 where there is none
        Rows effects;            // U
        double noise_scale = 1.0;
        Sled sled{};                                        // as far as the light tells it
        std::array<double, FitLight::kPoseColumns> back{};  // from there to the navigation's
        Eigen::VectorXd moved{};                            // signal less what `back` makes of it
        // What follows from these: D^-1 U, and (Gamma^-1 + U^T D^-1 U)^-1.
        Rows weighted_effects{};
        Eigen::MatrixXd effect_covariance{};
    };
    [[nodiscard]] Rows effects_at(const FitState& state,
                                  const PathLight& light,
                                  const Eigen::VectorXd& shares,
                                  const Sled& sled,
                                  Eigen::VectorXd& signal) const;
    void settle(Image& image) const;
    void look_from(const FitState& state,
                   const PathLight& light,
                   const Eigen::VectorXd& shares,
                   Image& image,
                   Eigen::VectorXd& signal) const;
    static void move_pose(const Eigen::VectorXd& effects, Image& image);
    // The image's own effects, as the residuals of a signal tell them.
    [[nodiscard]] static Eigen::VectorXd effects_in(const Image& image, const Eigen::VectorXd& off);
    // Columns of parts, then of numbers.
    [[nodiscard]] Rows columns_at(const FitState& state,
                                  const PathLight& light,
                                  const Eigen::VectorXd& shares,
                                  const std::vector<FitNumber>& numbers,
                                  const Sled& sled) const;
    // A^T V^-1 A of an image's columns.
    [[nodiscard]] static Eigen::MatrixXd information(const Image& image, const Rows& A);
    // The sandwich's, where left is D^-1 e.
    void add_meat(const Image& image,
                  const Rows& A,
                  const Eigen::VectorXd& left,
                  Normal& normal) const;
    void learn_effects(const std::vector<Eigen::VectorXd>& off);

    const FitLight& light_;
    int threads_;
    std::vector<Image> images_;
    std::vector<std::size_t> used_;  // of these, by parts() and normal()
    std::vector<std::size_t> tile_of_place_;
    EffectVariances effects_{};
    Eigen::MatrixXd tie_;  // what it adds to the parts' G; of no size: nothing
    BlockNoise noise_;
    double weights_factor_ = 1.0;
    std::size_t blocks_ = 0;
};

}  // namespace aphotic
