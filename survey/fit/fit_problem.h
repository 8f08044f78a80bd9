// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit looks for: which numbers of a rig are free, and what is known of each beforehand.
//
// A number is searched for as x, 0 where the rig has it:
//
//   value = start e^x    of what cannot be negative: powers, water, brightness
//   value = start + x    of all others
//
// Beforehand x is Gaussian, 0 +- `spread`; a beam's coefficients are as fit_beam.h says. These
// priors are weak: they move no number that the images tell, and leave those that the images do not
// tell where the rig has them, with the prior's error.
#pragma once

#include "rig/file/rig_text.h"
#include "survey/fit/fit_light.h"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct FitOptions {
    FitBeamKind beam = FitBeamKind::Table;
    bool has_beam_each = false;  // each strobe its own
    // The lens as 1 + a1 p^2 + a2 p^4 + a3 p^6, or as cos^n; none: as the rig has it, cos^n where
    // it has none.
    std::optional<bool> has_radial_vignetting{};
    // Words, or keys of numbers; none: the first six words that FitWords has. What is held is not
    // fitted, whatever is free.
    std::optional<std::vector<std::string>> free{};
    std::vector<std::string> hold{};
    // Spreads by word or key, in the key's unit; relative for what is searched for as e^x.
    std::map<std::string, double> priors{};
    // Standard deviations of what the navigation tells, image by image.
    double altitude_error_m = 0.02;
    double attitude_error_rad = 0.0087;
    int threads = 1;
};

struct FitNumber {
    FitPlaceInState at{};
    std::string key{};   // strobe.fore.power
    std::string word{};  // what it is asked for by: power
    double spread = 1.0;
    bool is_log = false;
    bool is_shown_exp = false;  // a beam's logarithm, which people know by its exponential
    double per_unit = 1.0;      // the key's unit, of the state's
    double least = 0.0;         // of x
    double most = 0.0;
    double start = 0.0;  // in the state

    [[nodiscard]] double value(double x) const;  // in the state
    [[nodiscard]] double slope(double x) const;  // of the value
    // The same in the key's unit.
    [[nodiscard]] double shown(double x) const;
    [[nodiscard]] double shown_slope(double x) const;
};

struct FitProblem {
    FitState start;
    std::vector<FitNumber> numbers;
    // Of R x - r, each of variance 1.
    Eigen::MatrixXd prior_rows;
    Eigen::VectorXd prior_means;

    [[nodiscard]] FitState state_at(const Eigen::VectorXd& x) const;
    [[nodiscard]] std::vector<FitPlaceInState> places() const;
};

// An InputError for a word or a key that is none, for what is said of numbers that are not fitted,
// and where none is.
void require_fit_options(const RigText& text, const FitOptions& options);
[[nodiscard]] FitProblem fit_problem(const RigText& text,
                                     const FitOptions& options,
                                     double widest_rad,
                                     double block_rad);

}  // namespace aphotic
