// SPDX-License-Identifier: BSD-3-Clause
//
// Which numbers of a rig a fit adjusts, and the prior of each.
//
// A number is searched as x, which is 0 at the rig's value:
//
//   value = start e^x    for what cannot be negative: powers, water, brightness, beams' shapes
//   value = start + x    for all others
//
// The prior of x is Gaussian, 0 +- `spread`; that of a beam's coefficients is in fit_beam.h. These
// priors are weak: they do not move numbers that the images determine, and leave the others at the
// rig's values, with the prior's error.
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
    bool has_beam_each = false;  // one for each strobe
    // The lens as 1 + a1 p^2 + a2 p^4 + a3 p^6, or as cos^n; empty: the rig's form, cos^n if it has
    // none.
    std::optional<bool> has_radial_vignetting{};
    // Words, or keys of numbers; empty: the words that are free by default. `hold` overrides it.
    std::optional<std::vector<std::string>> free{};
    std::vector<std::string> hold{};
    // Spreads by word or key, in the key's unit; relative for numbers searched as e^x.
    std::map<std::string, double> priors{};
    // Standard deviations of the navigation, per image.
    double altitude_error_m = 0.02;
    double attitude_error_rad = 0.0087;
    int threads = 1;
};

struct FitNumber {
    FitPlaceInState at{};
    std::string key{};   // strobe.fore.power; in lumens, strobe.fore.luminous_flux_lm
    std::string word{};  // power: names it in options
    double spread = 1.0;
    bool is_log = false;
    double per_unit = 1.0;  // the state's unit, in the key's
    double least = 0.0;     // of x
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
    // R and r: each row of R x - r has variance 1.
    Eigen::MatrixXd prior_rows;
    Eigen::VectorXd prior_means;

    [[nodiscard]] FitState state_at(const Eigen::VectorXd& x) const;
    [[nodiscard]] std::vector<FitPlaceInState> places() const;
};

// The key of a strobe's power in the rig's own unit, such as strobe.fore.luminous_flux_lm.
[[nodiscard]] std::string power_key(const RigText& text, const std::string& strobe);

// An InputError for an unknown word or key, for options about numbers that are not fitted, and if
// there is nothing to fit.
void require_fit_options(const RigText& text, const FitOptions& options);
[[nodiscard]] FitProblem fit_problem(const RigText& text,
                                     const FitOptions& options,
                                     double widest_rad,
                                     double block_rad);

}  // namespace aphotic
