// SPDX-License-Identifier: BSD-3-Clause
//
// The sharp cones that best fit a beam: for N cones about the axis, the half angles gamma_k and
// shares alpha_k >= 0 of the flux that minimise
//
//   integral of (I(w) - sum of alpha_k cos(theta) / (pi sin^2 gamma_k) [theta <= gamma_k])^2 dw
//
// Shares come from least squares, and a set of cones needs shares above 0. Half angles are
// multiples of kFitStep_deg: each further cone is the one that improves the fit most, then each in
// turn moves as long as that improves it. The result is a minimum that no single move improves, not
// always the global one.
//
//   error   (the integral / integral of I^2)^(1/2): the part that these cones do not fit
#pragma once

#include "rig/beam/beam.h"

#include <vector>

namespace aphotic {

inline constexpr double kFitStep_deg = 0.5;

struct ConeFit {
    std::vector<Cone> cones;  // weights by flux, narrowest first; fewer than N if more do not help
    double error = 0.0;
};

[[nodiscard]] ConeFit fit_cones(const Beam& beam, int count);

}  // namespace aphotic
