// SPDX-License-Identifier: BSD-3-Clause
//
// The rig that explains a survey: beams, aims, powers, water, vignetting and offsets of the pose,
// each with its standard error, or the reason why they cannot be told.
//
//   minimise over theta, beta >= 0   (y - A(theta) beta)^T V^-1 (y - A(theta) beta)
//                                    + sum_k ((theta_k - rig's) / plausible_k)^2
//
// y      the signal of blocks of images or maps (fit_samples.h)
// beta   shares of the beams' parts, in which A beta is linear (fit_light.h)
// theta  the numbers besides: the rig's are where the search starts
// V      noise, floor and errors of the poses (fit_equations.h), found in rounds
//
// beta is eliminated (variable projection: G. H. Golub and V. Pereyra 1973, with L. Kaufman's
// Jacobian, BIT 15, 1975, 49), theta is found by Ceres' Levenberg-Marquardt. plausible is how far a
// number may be from the rig's at all (kPlausible...): so weak that it moves none that the images
// tell, and it keeps those that they do not where they were.
//
// A number is told when the images alone give it to kTold of its plausible range. Those that are
// not, are held; or where they were asked for, refused, with what they are confounded with and the
// altitude at which further images would part them.
//
// The scale of all light is no part of a rig: powers are relative to the first strobe's of each
// beam, gains to green's.
#pragma once

#include "rig/rig_text.h"
#include "survey/fit_equations.h"
#include "survey/fit_light.h"
#include "survey/fit_samples.h"
#include "survey/run_watch.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kTold = 0.5;

struct FitOptions {
    FitBeamKind beam = FitBeamKind::Table;
    std::size_t parts = 24;      // of a table
    bool has_beam_each = false;  // each strobe its own
    // beam, aim, power, water, vignetting, altitude, attitude, gain, or a key of [water]; none: the
    // first five, as far as they can be told. The floor's colour is free besides, unless the
    // channels' gains are: these two cannot be parted.
    std::optional<std::vector<std::string>> free{};
    // Standard deviations of what the navigation tells, image by image.
    double altitude_error_m = 0.02;
    double attitude_error_rad = 0.0087;
    int threads = 1;
};

// A number with its error, as the rig's keys have it.
struct FittedNumber {
    FitNumber number;
    std::string key;
    double start = 0.0;
    double value = 0.0;
    double error = 0.0;
    double per_unit = 1.0;  // times the state's number
    bool is_at_bound = false;
};

// The two numbers that are told least apart, by the correlation of their errors.
struct Confounded {
    std::string one;
    std::string other;
    double correlation = 0.0;
};

// What the data do not tell, and why.
struct NotTold {
    std::string key;
    double error = 0.0;  // by the data alone, in units of the key
    std::string confounded_with{};
    std::optional<double> fly_at_m{};  // further images that would part them
    double error_then = 0.0;
};

[[nodiscard]] std::string words_of(const NotTold& one);

struct BeamPoint {
    double theta_rad = 0.0;
    double intensity = 0.0;  // of the beam scaled to a flux of 1
    double error = 0.0;
};

// What the fit leaves of an image, and what it makes of the image's own level and altitude.
struct ImageOutcome {
    Sled sled;
    double residual = 0.0;    // rms, relative
    double level = 0.0;       // of green, relative
    double altitude_m = 0.0;  // off the navigation's
};

// An image as blocks: R, G, B planar, NaN where left out.
struct FitView {
    std::size_t image = 0;
    std::vector<float> observed;
    std::vector<float> fitted;
    std::vector<float> residual;  // relative; the mean over channels, one plane
};
inline constexpr std::size_t kFitViews = 5;

// A sign that the model does not fit.
struct FitDoubt {
    std::string what;
    double size = 0.0;
};

struct FitResult {
    FitState state;
    Eigen::VectorXd shares;
    Eigen::MatrixXd covariance;  // of the shares, then the numbers, in the state's units
    std::vector<FittedNumber> numbers;
    std::vector<NotTold> held;
    std::vector<Confounded> confounded;               // |correlation| over 0.9, the largest first
    std::vector<std::vector<BeamPoint>> beam_curves;  // of tables and cosines, by beam
    std::vector<FitDoubt> doubts;
    std::vector<ImageOutcome> images;
    std::vector<FitView> views;  // kFitViews of them, from the lowest to the highest
    EffectVariances effects{};
    BlockNoise noise;
    double residual = 0.0;  // rms of blocks, relative to the signal, levels taken out
    double pattern = 0.0;   // of that, what stays in place from image to image
    std::size_t blocks = 0;
    std::size_t tiles = 0;
    int rounds = 0;
    int steps = 0;
};

[[nodiscard]] FitResult fit(const RigText& rig,
                            const FitSamples& samples,
                            const FitOptions& options,
                            const RunWatch& watch);

}  // namespace aphotic
