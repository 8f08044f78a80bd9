// SPDX-License-Identifier: BSD-3-Clause
//
// The sharp cones that come closest to a beam: of N cones about the axis, the half angles gamma_k
// and shares alpha_k >= 0 of the flux that make
//
//   integral of (I(w) - sum of alpha_k cos(theta) / (pi sin^2 gamma_k) [theta <= gamma_k])^2 dw
//
// small. Shares are by non-negative least squares. Half angles are multiples of kFitStep_deg: each
// further cone is the one that helps most, then each in turn moves as long as that helps, so they
// are a minimum that no single move betters, not always the least of all.
//
//   error   (the integral / integral of I^2)^(1/2): what no sum of these cones has
#pragma once

#include "rig/beam/beam.h"

#include <vector>

namespace aphotic {

inline constexpr double kFitStep_deg = 0.5;

struct ConeFit {
    std::vector<Cone> cones;  // weights by flux, the narrowest first; fewer where more do not help
    double error = 0.0;
};

[[nodiscard]] ConeFit fit_cones(const Beam& beam, int count);

}  // namespace aphotic
