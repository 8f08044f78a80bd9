// SPDX-License-Identifier: BSD-3-Clause
//
// The rig that explains a survey: beams, aims, powers, water, vignetting and offsets of the pose,
// with the errors of each and of the light that they make.
//
// The result is the most probable rig by fit_objective.h; its errors come from fit_errors.h.
//
// A number is determined if its error is under kDetermined of its prior spread. Others keep about
// the prior's error, and are named, with the altitude at which as many images again would determine
// them best, if that helps at all.
//
// The overall scale of the light is not part of a rig: the sum of the powers stays that of the rig.
#pragma once

#include "rig/file/rig_text.h"
#include "survey/fit/fit_problem.h"
#include "survey/fit/fit_samples.h"
#include "survey/fixed_pattern.h"
#include "survey/run_watch.h"
#include "survey/survey_check.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

inline constexpr double kDetermined = 0.7;

// The effect of as many images again at an altitude.
struct FlyAt {
    double altitude_m = 0.0;
    double error = 0.0;
};

// A number in the units of the rig's key.
struct FittedNumber {
    std::string key{};
    std::string word{};
    double start = 0.0;
    double value = 0.0;
    double error = 0.0;
    double spread = 0.0;  // the prior's, at the start
    bool is_log = false;  // its prior is of the logarithm
    bool is_determined = true;
    std::optional<FlyAt> fly_at{};  // for an undetermined one
};

// A coefficient of a beam's table, better viewed as its curve.
[[nodiscard]] bool is_curve(const FittedNumber& number);

struct BeamPoint {
    double theta_rad = 0.0;
    double intensity = 0.0;  // for a beam scaled to a flux of 1
    double error = 0.0;
};

// To two significant digits of its error, "4.06 +- 0.13" with that sign.
[[nodiscard]] std::string with_error(const FittedNumber& number, std::string_view sign = "+-");

// Two numbers that compensate for each other.
struct Confounded {
    std::string one;
    std::string other;
    double correlation = 0.0;
};

struct ImageOutcome {
    std::string name;
    Sled sled;                // from the navigation or the depth map
    Eigen::Vector3d off;      // fitted, less that
    double brightness = 0.0;  // of its floor relative to the mean of all, logarithm
};

// An image as blocks: R, G, B planar, NaN where omitted.
struct FitView {
    std::size_t image = 0;
    std::vector<float> observed;
    std::vector<float> fitted;
};
inline constexpr std::size_t kFitViews = 3;

struct FitResult {
    FitState state;
    std::vector<FittedNumber> numbers;
    Eigen::MatrixXd covariance;                       // of the numbers, in the keys' units
    std::vector<std::string> fixed;                   // words of --free held at the rig's values
    std::vector<Confounded> confounded;               // |correlation| over 0.9, largest first
    std::vector<std::vector<BeamPoint>> beam_curves;  // of fitted round beams
    double unevenness = 0.0;    // expected of a correction with this rig over the flight, rms
    double moved = 0.0;         // by which the fitted light differs from the rig's; likewise, rms
    double veil_share = 0.0;    // of the signal, mean
    double texture = 0.0;       // of neighbouring blocks' differences, of green
    double level_spread = 0.0;  // of images
    FixedPattern pattern;       // of green, by block
    std::vector<ImageOutcome> images;
    std::vector<FitView> views;
    std::vector<Suspicion> looks_wrong;
    std::vector<MarkedImage> marked;  // dropouts, left out
    bool are_maps = false;
    int block_px = 1;
    std::size_t blocks = 0;
    double dispersion = 1.0;
    int rounds = 0;
};

// What a correction by the rig as it was is expected to leave: the fitted light is off by the fit's
// error, and independently of that the rig's by the rest of what they differ by.
[[nodiscard]] double rig_unevenness(const FitResult& result);
// Whether that is no more than by the fitted rig: the survey does not show that the rig is wrong.
[[nodiscard]] bool is_rig_as_good(const FitResult& result);

// An InputError for a rig whose floor a fit does not support: with objects, a scene, or a gloss.
void require_bare_floor(const Rig& rig);

[[nodiscard]] FitResult fit(const RigText& rig,
                            const FitSamples& samples,
                            const FitOptions& options,
                            const RunWatch& watch);

// Such as "11 numbers and a beam of 17 splines fitted to 40 images".
[[nodiscard]] std::string words_of(const FitResult& result);
// Such as "strobe.fore.power is not determined by this survey (+-0.09): as many images again at
// 1.2 m would bring its error to 0.04".
[[nodiscard]] std::string words_of(const FittedNumber& undetermined);

}  // namespace aphotic
