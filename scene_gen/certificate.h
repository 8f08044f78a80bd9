// SPDX-License-Identifier: BSD-3-Clause
//
// What a fitted rule is held to before anything is rendered, by integrals over wavelength that
// share nothing with the fit's (spectral/panel_quadrature.h): first over the whole family of light
// (spectral/quadrature_certificate.h), then behind a port over the image.
//
// Behind a port every wavelength shows a point of the floor of its own, and a pixel's light changes
// over wavelength along a curve of its own, of which the family's tilt is an envelope. So the rule
// is tried on the pixels themselves, on an even grid of the image from corner to corner:
//
//   error_c = kBetweenPixels max over the grid of |sum_j w_cj L_j / S_c - 1|
//   S_c     = int L Q_c dlambda          L_j  what frame j holds, with its own refractive indices
//
// Pixels darker than black, 1e-8 of the brightest, do not count. Nor does light that dispersion
// carries over the edge of a cone: such pixels are on an edge. Objects are left out: on them the
// tilt is stated, not measured (scene_gen/light_paths.h).
#pragma once

#include "rig/rig.h"
#include "spectral/quadrature_fit.h"

#include <array>
#include <span>
#include <vector>

namespace aphotic {

// The grid's maximum may lie between its points.
inline constexpr double kBetweenPixels = 1.02;

// What one wavelength's frame holds of the bare floor.
struct FloorFrame {
    double index_nm = 0.0;  // whose refractive indices it has
    double attenuation_per_m = 0.0;
    double reflectance = 0.0;
    std::vector<double> spectrum{};  // of each strobe at power 1
};

// Of the rig's own light.
[[nodiscard]] FloorFrame floor_frame(const Rig& rig, double lambda_nm, double index_nm);

// In view through the port, by channel.
[[nodiscard]] std::array<double, kChannels> port_error(const Rig& rig,
                                                       std::span<const WeightedWavelength> rule,
                                                       std::span<const FloorFrame> frames);

// Raises the rule's quality to what is found. in_view: of a user's own scene, none.
void certify(const Rig& rig,
             const QuadratureFitter& fitter,
             std::span<const FrameLight> frames,
             std::span<const FloorFrame> in_view,
             FittedRule& rule);

}  // namespace aphotic
