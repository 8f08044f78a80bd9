// SPDX-License-Identifier: BSD-3-Clause
//
// The veil (light/veil.h) from POV-Ray's scattering media, including objects' shadows in it.
//
//   A(lambda) ~ sum_m S_m(lambda) A_m        S_m = sum_i b_i share_im
//
// A POV-Ray medium has one phase function for all wavelengths. The veil therefore has its own
// frames besides those of the direct light: lamps shine, floor and objects are black, and each lobe
// m of the water's phase functions (spectral/phase_lobes.h) has a frame, which is subtracted if its
// S_m is negative.
//
// The wavelengths are those of the direct light; their weights for the veil are fitted to it as if
// b_i were a floor's reflectance, on paths from lamp to water to camera.
//
// The known part of its error, in water over the bare floor, is measured on a coarse grid of the
// image against light/veil.h: the lobes, the samples (scene_gen/media_samples.h), and the
// amplification of the half floats' rounding by cancelling lobes. Light deflected by less than
// kVeilCut is not cut off, and counts in the measured error. The error is not a bound.
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"
#include "scene_gen/media_samples.h"
#include "spectral/light_family.h"
#include "spectral/planned_wavelength.h"
#include "spectral/quadrature_fit.h"

#include <array>
#include <span>

namespace aphotic {

// The error for HabCam is 5e-4 for smooth light, and a tenth of that for cones.
inline constexpr int kVeilSamples = 50;

struct PovrayVeil {
    MediaSampling sampling;
    double error = 0.0;                            // of the veil's radiance, relative
    std::array<RuleQuality, kChannels> quality{};  // of the weights
};

struct PovrayVeilRequest {
    int samples = kVeilSamples;
    std::span<const LampGrid> lamps;
    bool is_user_scene = false;  // with strobes at any place
    bool fits_weights = true;    // false: the wavelengths' own weights
    double frame_error = 0.0;
};

// family: of the direct light, for its longest path and a port's tilt. Sets the wavelengths' veil
// except for its exposure.
[[nodiscard]] PovrayVeil plan_povray_veil(const Rig& rig,
                                          const LightFamily& family,
                                          const PovrayVeilRequest& request,
                                          std::span<PlannedWavelength> wavelengths);

// The quality of a rule for floor and veil together: a pixel is no worse than the worse of the two.
[[nodiscard]] std::array<RuleQuality, kChannels> with_povray_veil(
    std::array<RuleQuality, kChannels> quality, const PovrayVeil& veil);

}  // namespace aphotic
