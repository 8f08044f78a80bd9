// SPDX-License-Identifier: BSD-3-Clause
//
// Phase functions as sums of lobes that a renderer knows:
//
//   p(psi) ~ sum_m share_m q_m(psi)        q_m  Henyey and Greenstein's of any g, and molecular
//                                               scattering without depolarisation, Rayleigh's
//
// Henyey and Greenstein's function is its own lobe, molecular scattering is Rayleigh's and an
// isotropic lobe (g = 0), both exactly. Any other function is fitted, of least squares relative to
// p over a range of angles: kMostLobes in all, one after the other where it helps most, until no
// angle is off by more than kLobesSuffice.
//
// Shares may be negative: a sum of lobes without comes no nearer to Fournier and Forand's function
// than 4 to 10 %. What is rendered of each lobe then cancels in part, its rounding does not: the
// largest sum |share_m| q_m / p is the amplification, which the fit holds down.
//
// Outside the range of angles nothing is fitted. All phase functions of a water have the same
// lobes, so that each is rendered once.
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
    // The largest of any phase function, over the angles.
    double error = 0.0;
    double amplification = 1.0;
};

// 0 <= from < to <= pi.
[[nodiscard]] PhaseLobes lobes_of(std::span<const PhaseFunction> phases,
                                  double from_rad,
                                  double to_rad);

}  // namespace aphotic
