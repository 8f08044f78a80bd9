// SPDX-License-Identifier: BSD-3-Clause
//
// A lamp's flux from its spectrum:
//
//   radiant    integral of S dlambda                     [W, for S in W/nm]
//   luminous   683 lm/W  integral of S V dlambda         [lm]
//
//   S   the lamp's table, over all of its range
//   V   the CIE's luminous efficiency: ybar of the 1931 observer (cie-1931)
//
// This is exact for the tables: between the knots of both, S V is a parabola.
//
// Limit: a table that ends within the visible range has no luminous flux, except that it may miss
// up to kMostUnseen of V's integral.
#pragma once

#include "spectral/spectrum.h"

namespace aphotic {

inline constexpr double kLumensPerWatt = 683.0;
inline constexpr double kMostUnseen = 0.005;

[[nodiscard]] double radiant_flux_w(const Spectrum& lamp);

// An InputError if the table misses more than kMostUnseen.
[[nodiscard]] double luminous_flux_lm(const Spectrum& lamp);

}  // namespace aphotic
