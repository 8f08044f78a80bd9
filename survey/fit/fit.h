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
// number may be from the rig's at all (fit_problem.h): so weak that it moves none that the images
// tell, and it keeps those that they do not where they were.
//
// A number is told when the images alone give it to kTold of its plausible range. Those that are
// not, are held; or where they were asked for, refused, with what they are confounded with and the
// altitude at which further images would part them. The errors of the others allow for those held
// to be off by as much as is plausible.
//
// Of ten images and more a beam's table has as many parts as these tell (fit_parts.h): with more it
// would follow the floor's texture, and seem to tell aims to a hair that it tells wrong.
//
// Errors are the sandwich of fit_equations.h. Of ten images and more the variance by halves of the
// images (fit_halves.h) takes its place where it is larger by more than chance. It knows no model
// of the noise, nor that the light is anything like a straight line in the numbers: on a rough
// floor many rigs explain the images almost equally well, and halves come to different ones.
//
// The scale of all light is no part of a rig: powers are relative to the first strobe's of each
// beam, gains to green's.
#pragma once

#include "rig/file/rig_text.h"
#include "survey/fit/fit_equations.h"
#include "survey/fit/fit_light.h"
#include "survey/fit/fit_problem.h"
#include "survey/fit/fit_residuals.h"
#include "survey/fit/fit_samples.h"
#include "survey/fit/fit_told.h"
#include "survey/run_watch.h"
#include "survey/survey_check.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

// A number with its error, as the rig's keys have it.
struct FittedNumber {
    FitNumber number;
    std::string key;
    double start = 0.0;
    double value = 0.0;
    double error = 0.0;
    double plausible = 0.0;  // how far from the start it may well be
    double per_unit = 1.0;   // times the state's number
    bool is_at_bound = false;
};

struct BeamPoint {
    double theta_rad = 0.0;
    double intensity = 0.0;  // of the beam scaled to a flux of 1
    double error = 0.0;
};

struct FitResult {
    FitState state;
    Eigen::VectorXd shares;
    Eigen::MatrixXd covariance;  // of the shares, then the numbers, in the state's units
    std::vector<FittedNumber> numbers;
    std::vector<NotTold> held;
    std::vector<std::string> fixed;                   // words of --free: as the rig has them
    std::vector<Confounded> confounded;               // |correlation| over 0.9, the largest first
    std::vector<std::vector<BeamPoint>> beam_curves;  // of fitted ones that are round
    FitResiduals left;
    std::vector<Suspicion> looks_wrong;
    bool are_maps = false;
    int block_px = 1;
    EffectVariances effects{};
    BlockNoise noise;
    std::size_t blocks = 0;
    std::size_t tiles = 0;
    int rounds = 0;
    int steps = 0;
};

// An InputError for a rig whose floor a fit does not know: with objects, a scene, or a gloss.
void require_bare_floor(const Rig& rig);

// Of the solver, for the whole process: what went wrong is in what fit() throws. The log is glog's,
// and the host of our libraries may have set its level for itself: the command alone calls this.
void silence_fit_log();

[[nodiscard]] FitResult fit(const RigText& rig,
                            const FitSamples& samples,
                            const FitOptions& options,
                            const RunWatch& watch);

// Such as "11 numbers and a beam of 8 splines fitted to 40 images".
[[nodiscard]] std::string words_of(const FitResult& result);

}  // namespace aphotic
