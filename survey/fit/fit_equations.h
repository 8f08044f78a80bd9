// SPDX-License-Identifier: BSD-3-Clause
//
// The normal equations of a fit, over all of its images: of the signal y = A x + U c + e of each,
//
//   A   columns: the beams' parts (fit_light.h), then the numbers that are free
//   e   noise of a block over its channels (fit_noise.h), found from the residuals themselves
//   U c what blocks of an image share: the floor's level, and that of red and of blue beside it,
//       for floors are brighter here than there and of another hue, and its brightness across the
//       image, for its texture has waves as long as an image: cos(a pi x) cos(b pi y), a + b from 1
//       to kWaves, x and y from 0 to 1, all of the floor's light and not of the veil before it; and
//       errors of the image's own altitude, pitch and roll. c is random, with a variance each: of
//       the pose as the instruments have it, of the floor found from five images on, one for all
//       waves of the same a + b (Dempster, Laird and Rubin's EM), up to kMostEffect squared: floors
//       hardly differ by more, and without a bound a wrong beam ends where nothing is told
//
// Poses go into the light as no straight line: each image's is moved to where its light tells it,
// round by round, and what the navigation says becomes the mean of what is left of it in c. Not
// farther than kMostMove standard deviations: far from the answer a straight line leads anywhere.
//
// So y has the covariance V = D + U Gamma U^T, D that of e, W^T W = D^-1 block by block, and
//
//   A^T V^-1 A = (W A)^T (W A) - (W A)^T W U (Gamma^-1 + (W U)^T W U)^-1 (W U)^T W A
//
// A table's parts are tied so weakly that little changes where the images see them: their
// differences are random, with the standard deviation kTie of their size, and so are the
// differences of these, with kBend. The size is the least share from the axis up to there, and
// kDimmestTie of the largest at least: few lamps grow brighter off their axis. So a beam goes on as
// it was where nobody looks, as dim as it was, and where few do it does not swing between parts
// that make up for each other. Tighter ties, of 0.3 and 0.1, bias what is hardly told: in water
// that scatters, the floor came out one standard error too bright.
//
// Blocks that are off count less, by the biweight, and those far off nothing: on rough floors
// stones shade what is behind them, where the light is no flat floor's. Far from the rig that would
// take what is right for stones, so the first rounds weigh by Huber's, which forgets nothing. The
// covariance of what is fitted is the sandwich
//
//   C = H^-1 ( f^2 sum over tiles s s^T + sum over images Z Gamma Z^T + T ) H^-1
//   H = A^T V^-1 A + T
//
// T is that of the ties and of what is plausible, for these are random, too. s is (D V^-1 A)^T D^-1
// (y - A x - U c) over a tile, a part of an image within which noise may be correlated as it likes,
// and Z is A^T V^-1 U. It holds whatever e is, though D be wrong (P. J. Huber 1967; H. White,
// Econometrica 48, 1980, 817).
//
// f: mean weight over mean slope of the influence e w(e), by which weights that move with the fit
// widen what noise does to it (P. J. Huber, Robust Statistics, 1981, 6.5); what all blocks of an
// image share moves weights and slopes alike.
#pragma once

#include "survey/fit/fit_light.h"
#include "survey/fit/fit_noise.h"
#include "survey/fit/fit_samples.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr double kTie = 0.9;
inline constexpr double kBend = 0.2;
inline constexpr double kDimmestTie = 0.05;
inline constexpr double kMostMove = 3.0;
inline constexpr double kMostEffect = 0.5;
inline constexpr std::size_t kTilesAcross = 8;
inline constexpr std::size_t kTilesDown = 6;

// Level, that of red and of blue beside it, then altitude, pitch and roll, then the waves.
inline constexpr int kWaves = 5;
inline constexpr std::size_t kPoseEffect = 3;  // the first of the pose's
inline constexpr std::size_t kWaveEffect = 6;  // and of the waves'
inline constexpr std::size_t kEffects = kWaveEffect + (kWaves + 1) * (kWaves + 2) / 2 - 1;
using EffectVariances = std::array<double, kEffects>;

class FitEquations {
  public:
    using Rows = FitLight::Rows;

    FitEquations(const FitLight& light, const FitSamples& samples, int threads);

    // The first noise: kFirstNoise of the signal, kFirstFloor of the brightest, no effects.
    void assume_noise();
    // What the residuals of this solution tell. estimate_effects: let EM move the variances.
    void learn_noise(const FitState& state,
                     const PathLight& light,
                     const Eigen::VectorXd& shares,
                     Robust robust,
                     bool estimate_effects);
    // From now on parts are tied; none before, nor once they are untied.
    void tie_parts(const FitState& state, const Eigen::VectorXd& shares);
    void untie();
    void set_effects(const EffectVariances& variances);
    // As large as the residuals of a solution without effects, with some room, and no larger than
    // `most`: few images, from which none are learned, may be of a grey card.
    void start_effects(const FitState& state,
                       const PathLight& light,
                       const Eigen::VectorXd& shares,
                       const EffectVariances& most);
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

    [[nodiscard]] std::size_t blocks() const { return blocks_; }

  private:
    struct Image {
        Eigen::VectorXd signal;                // 0 where there is none
        std::vector<ChannelMatrix> whitening;  // by place; its rows are 0 where there is none
        Rows effects;                          // U
        double noise_scale = 1.0;
        Sled sled{};                                        // as far as the light tells it
        std::array<double, FitLight::kPoseColumns> back{};  // from there to the navigation's
        Eigen::VectorXd moved{};                            // signal less what `back` makes of it
        // What follows from these: W U, and (Gamma^-1 + U^T D^-1 U)^-1.
        Rows white_effects{};
        Eigen::MatrixXd effect_covariance{};

        [[nodiscard]] bool has(Eigen::Index row) const;
        // Values of a block, NaN where it has none.
        [[nodiscard]] BlockChannels block(const Eigen::VectorXd& of, std::size_t place) const;
        // W of these.
        [[nodiscard]] Rows white(Rows columns) const;
        // W (1 - U C U^T D^-1) of what is off: what its own effects cannot take up.
        [[nodiscard]] Eigen::VectorXd white_rest(const Eigen::VectorXd& off) const;
        // Its effects, as what is off tells them.
        [[nodiscard]] Eigen::VectorXd effects_in(const Eigen::VectorXd& off) const;
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
    void move_pose(const Eigen::VectorXd& effects, Image& image) const;
    // Columns of parts, then of numbers.
    [[nodiscard]] Rows columns_at(const FitState& state,
                                  const PathLight& light,
                                  const Eigen::VectorXd& shares,
                                  const std::vector<FitNumber>& numbers,
                                  const Sled& sled) const;
    void add_tie(const Eigen::VectorXd& shares, Normal& normal) const;
    // A^T V^-1 A of an image's columns, as W A.
    [[nodiscard]] static Eigen::MatrixXd information(const Image& image, const Rows& white);
    // The sandwich's, where left is W of what is left.
    void add_meat(const Image& image,
                  const Rows& white,
                  const Eigen::VectorXd& left,
                  Normal& normal) const;
    struct Influences {
        double weights = 0.0;
        double slopes = 0.0;
    };
    Influences weigh(const Eigen::VectorXd& signals,
                     const Eigen::VectorXd& residuals,
                     Robust robust,
                     Image& image) const;
    void learn_effects(const std::vector<Eigen::VectorXd>& off);

    const FitLight* light_;  // so that it can be assigned
    int threads_;
    Rows waves_;  // by place
    std::vector<Image> images_;
    std::vector<std::size_t> tile_of_place_;
    EffectVariances effects_{};
    Eigen::MatrixXd tie_;  // what it adds to the parts' G; of no size: nothing
    BlockNoise noise_;
    double weights_factor_ = 1.0;  // f
    std::size_t blocks_ = 0;
};

}  // namespace aphotic
