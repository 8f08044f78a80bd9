// SPDX-License-Identifier: BSD-3-Clause
//
// The error of a rule of wavelengths and weights, found independently of the fit that made it:
// every member of the family of light (spectral/light_family.h) is integrated anew, with
// spectral/panel_quadrature.h and in long double, whose range includes e^-11000.
//
//   error_c = max over sources, tilts and paths of |sum_j w_cj f_j / T_c - 1|
//   T_c     = int f Q_c dlambda
//
// A member to which the channel is blind (kBlind of spectral/quadrature_fit.h) must have no weight.
// Tilts and paths lie between those of the fit and of its own check.
#pragma once

#include "spectral/light_family.h"
#include "spectral/quadrature_fit.h"

#include <array>
#include <span>

namespace aphotic {

inline constexpr int kCertifiedPaths = 200;
inline constexpr int kCertifiedPathsOfEachTilt = 50;

// By channel: zero for one that sees nothing, an infinite error for one whose weights include light
// to which it is blind. frames: the light in each wavelength's frame, in the rule's order.
[[nodiscard]] std::array<RuleQuality, kChannels> certified_quality(
    const Sensor& sensor,
    const LightFamily& family,
    WavelengthRange range,
    std::span<const WeightedWavelength> rule,
    std::span<const FrameLight> frames);

}  // namespace aphotic
