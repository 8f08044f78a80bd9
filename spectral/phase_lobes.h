// SPDX-License-Identifier: BSD-3-Clause
//
// Phase functions as sums of lobes available in a renderer:
//
//   p(psi) ~ sum_m share_m q_m(psi)        q_m  Henyey and Greenstein's of any g, and molecular
//                                               scattering without depolarisation, Rayleigh's
//
// Henyey and Greenstein's function is its own lobe; molecular scattering is Rayleigh's plus an
// isotropic lobe (g = 0); both are exact. Any other function is fitted by least squares relative to
// p over a range of angles, with at most kMostLobes lobes, added one at a time where they help
// most, until no angle is off by more than kLobesSuffice.
//
// Shares may be negative: without them, a sum of lobes comes no closer to Fournier and Forand's
// function than 4 to 10 %. The rendered lobes then partly cancel, but their rounding does not: the
// largest sum |share_m| q_m / p is the amplification, which the fit limits.
//
// Angles outside the range are not fitted. All phase functions of a water share their lobes, so
// that each is rendered once.
#pragma once

#include "spectral/phase_function.h"

#include <cstddef>
#include <span>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kMostLobes = 6;
inline constexpr double kLobesSuffice = 5e-4;

struct PhaseLobes {
    std::vector<PhaseFunction> lobes{};        // HenyeyGreenstein, or molecular of ratio 0
    std::vector<std::vector<double>> share{};  // by phase function, by lobe
    // The largest values over all phase functions and angles.
    double error = 0.0;
    double amplification = 1.0;
};

// 0 <= from < to <= pi.
[[nodiscard]] PhaseLobes lobes_of(std::span<const PhaseFunction> phases,
                                  double from_rad,
                                  double to_rad);

}  // namespace aphotic
