// SPDX-License-Identifier: BSD-3-Clause
//
// Weights with which a few wavelengths represent the whole spectrum of a family of light:
//
//   S_c = int L Q_c dlambda  ~  sum_j w_cj L_j
//
//   error          e_c = max over the family of |sum_j w_cj f_j / T_c - 1|
//   amplification  a_c = max over the family of sum_j |w_cj| f_j / T_c
//   promise        e_c + a_c frame_error
//
// f_j   light of a member of the family in the frame of wavelength j (FrameLight)
// T_c   the member's signal in channel c, integrated exactly (reference_grid)
// frame_error   the relative error of a frame's samples, mostly from half floats
//
// A pixel's light is a sum of members with non-negative factors, so no pixel errs by more than the
// promise, relative to its own signal. Fitted weights make e_c as small as possible
// (spectral/minimax.h); if that needs weights of either sign so large that the promise suffers,
// they are penalised.
//
// A channel may be blind to a member: its response to it is less than kBlind, light for light, of
// its response to the member that it sees best. Such light is ignored, provided that it has no
// weight either: a wavelength of such light has weight 0 in that channel. So has a wavelength so
// dark that it would need a weight over kMostWeight times the channel's whole response to
// contribute.
//
// Behind a port, each pixel's light varies over wavelength along a curve of its own, and the
// family's tilt is the largest. For the curves' shapes, kTiltShape of half its span is added to the
// error.
//
// The frames need not show the family's own water, lamps or materials: any light of the same
// geometry serves as well as it spans the family.
#pragma once

#include "spectral/light_family.h"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace aphotic {

// Half floats round by at most 2^-11; the rest is for single-precision colours and POV-Ray's
// computation of the inverse square law.
inline constexpr double kFrameError = 0x1p-11 + 2e-6;

struct RuleQuality {
    double error = 0.0;
    double amplification = 0.0;

    [[nodiscard]] double promise(double frame_error) const {
        return error + amplification * frame_error;
    }
};

// The worst channel's.
[[nodiscard]] double worst_error(std::span<const RuleQuality> channels);
[[nodiscard]] double worst_promise(std::span<const RuleQuality> channels, double frame_error);

struct FittedRule {
    std::vector<WeightedWavelength> wavelengths{};
    std::array<RuleQuality, kChannels> quality;  // zero for a channel that sees nothing

    [[nodiscard]] double error() const { return worst_error(quality); }
    [[nodiscard]] double promise(double frame_error) const {
        return worst_promise(quality, frame_error);
    }
};

// The light in the frame of one wavelength.
struct FrameLight {
    double lambda_nm = 0.0;
    double attenuation_per_m = 0.0;
    std::vector<double> sources{};  // in the order of LightFamily::sources
    double tilt = 0.0;              // LightFamily::tilt at the wavelength of its indices
};

class QuadratureFitter {
  public:
    QuadratureFitter(const Sensor& sensor, const LightFamily& family, WavelengthRange range);

    // The light of a frame with the family's own water, lamps and materials.
    [[nodiscard]] FrameLight frame_at(double lambda_nm) const;

    // The weights, and their error, determined on kCheckPaths paths that the fit did not use and,
    // behind a port, on twice as many tilts.
    [[nodiscard]] FittedRule fit(std::span<const FrameLight> frames, double frame_error) const;

    // The same for given weights; the error is infinite where a channel's weights give it light to
    // which it is blind.
    [[nodiscard]] std::array<RuleQuality, kChannels> judge(
        std::span<const WeightedWavelength> rule, std::span<const FrameLight> frames) const;

    // For trying many frames: a frame's light relative to the signals of the fit's members, and the
    // cost of a fit to such columns, in few steps. The cost is the error; amplification beyond
    // kFreeAmplification counts with its effect on frame_error. A cost known to exceed give_up is
    // returned as infinite. `hint` carries information from one trial to the next.
    struct Column {
        std::array<Eigen::MatrixXd, kChannels> light;  // of one frame, or one column per frame
    };
    using Hint = std::array<Eigen::ArrayXd, kChannels>;
    [[nodiscard]] Column column_of(std::span<const FrameLight> frames) const;
    [[nodiscard]] double quick_cost(std::span<const Column* const> columns,
                                    double frame_error,
                                    double give_up,
                                    Hint& hint) const;

    // A lower bound of the cost of any fit to these columns plus one of the candidates.
    [[nodiscard]] Eigen::ArrayXd least_costs(std::span<const Column* const> columns,
                                             const Column& candidates,
                                             const Hint& hint) const;

    // About `count` wavelengths where the relevant light is: nodes of the reference grid. Each node
    // counts with the root of its contribution to the signal of the member to which it contributes
    // most, and equal shares of the sum lie between wavelengths. The root spreads them: nearly all
    // the light of a long path may be in a few nm. A line too narrow for that, of a lamp or of a
    // channel's response to it, gets three more.
    [[nodiscard]] std::vector<double> places_of_light(int count) const;

    // The error over path length, by source and channel, for plots.
    struct PathError {
        double path_m;
        std::array<double, kChannels> error{};
    };
    [[nodiscard]] std::vector<PathError> errors_over_path(const FittedRule& rule,
                                                          std::span<const FrameLight> frames,
                                                          std::size_t source) const;

    // The error added by the shapes of pixels' own tilts; 0 without a port.
    [[nodiscard]] double tilt_shape_error() const;

    [[nodiscard]] const LightFamily& family() const { return family_; }

  private:
    // Members of the family and their signals: for every source, tilt and path, in this order. All
    // are scaled by exp(K_0 l), K_0 the least loss in the range, so that even a long path does not
    // underflow a double. Only ratios of a member to itself are used.
    struct Sample {
        Eigen::ArrayXd path_m;
        std::vector<double> tilts;
        Eigen::ArrayXXd signals{};  // members by channels
        Eigen::ArrayXXd
            response{};          // the same, relative to all of a member's light; 0: it has none
        Eigen::ArrayXd light{};  // all light of a member, int f dlambda
    };
    // The frames as one channel sees them: their light relative to the channel's response to each
    // member, and which frames it may use.
    struct View {
        Eigen::MatrixXd relative{};
        double whole_response = 0.0;  // int Q_c dlambda
        // By frame: the largest ratio of its light over the range to all light of a member to which
        // the channel is blind.
        Eigen::ArrayXd unseen;
        std::vector<bool> is_usable{};

        // Frames that may not be used count as dark.
        [[nodiscard]] Eigen::MatrixXd usable() const;
    };

    [[nodiscard]] Sample sample(Eigen::ArrayXd paths_m, std::vector<double> tilts) const;
    [[nodiscard]] Eigen::MatrixXd light_of(const Sample& sample,
                                           std::span<const FrameLight> frames) const;
    [[nodiscard]] View view_of(const Eigen::MatrixXd& light,
                               const Sample& sample,
                               Eigen::Index channel) const;

    LightFamily family_;
    double least_attenuation_per_m_ = 0.0;
    // The reference grid, tabulated.
    Eigen::ArrayXd grid_lambda_nm_;
    Eigen::ArrayXd grid_attenuation_per_m_;
    Eigen::ArrayXd grid_tilt_;
    Eigen::ArrayXXd grid_sources_;  // wavelengths by sources
    Eigen::ArrayXXd grid_weights_;  // wavelengths by channels
    Eigen::ArrayXd grid_width_nm_;  // of light, not of a channel
    Sample fitting_;
    Sample checking_;
};

inline constexpr int kCheckPaths = 161;
// A source's light under kDarkness of the brightest source's on the same path is ignored, a
// channel's response to a member under kBlind of its best counts as 0, and weights that sum to less
// than kLeak of its best over the whole range count as 0 for that member.
inline constexpr double kDarkness = 1e-200;
inline constexpr double kBlind = 1e-50;
inline constexpr double kLeak = 1e-40;
inline constexpr double kMostWeight = 1e20;
inline constexpr double kTiltShape = 0.01;
inline constexpr double kFreeAmplification = 1.25;

}  // namespace aphotic
