// SPDX-License-Identifier: BSD-3-Clause
//
// The check of a fitted rule before anything is rendered, by integrals over wavelength that are
// independent of the fit's (spectral/panel_quadrature.h): first over the whole family of light
// (spectral/quadrature_certificate.h), then, behind a port, over the image.
//
// Behind a port every wavelength shows its own point of the floor, and each pixel's light varies
// over wavelength along its own curve, of which the family's tilt is an envelope. So the rule is
// tested on the pixels themselves, at places_along() the image's sides (scene_gen/light_paths.h):
//
//   error_c = kBetweenPixels max over the places of |sum_j w_cj L_j / S_c - 1|
//   S_c     = int L Q_c dlambda          L_j  light of frame j, with its own refractive indices
//
// Pixels darker than black, 1e-8 of the brightest, are ignored. So is light that dispersion shifts
// across the edge of a cone: such pixels are on an edge. Objects are omitted: on them the tilt is
// assumed, not computed (scene_gen/light_paths.h).
#pragma once

#include "rig/rig.h"
#include "spectral/planned_wavelength.h"
#include "spectral/quadrature_fit.h"

#include <array>
#include <span>

namespace aphotic {

// The maximum may lie between the places.
inline constexpr double kBetweenPixels = 1.02;

// The error behind a port, by channel, for the bare floor lit at the wavelengths.
[[nodiscard]] std::array<double, kChannels> port_error(const Rig& rig,
                                                       std::span<const PlannedWavelength> rule);

// Raises the errors in the rule's quality to those found. in_view: the same rule's wavelengths if
// the bare floor is in view; null for a user's scene.
void certify(const Rig& rig,
             const QuadratureFitter& fitter,
             std::span<const FrameLight> frames,
             std::span<const PlannedWavelength> in_view,
             FittedRule& rule);

}  // namespace aphotic
