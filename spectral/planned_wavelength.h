// SPDX-License-Identifier: BSD-3-Clause
//
// Everything planned for one wavelength, from its choice to the manifest: the plan sets its weights
// and frame, the scenes set its exposure, the integrator uses both.
//
//   S_c = sum_j w_cj L(lambda_j),     L(lambda_j) = 2^-e_j F_j
//
// and the same for the veil, if it has frames.
//
// S_c  signal of channel c      L  spectral radiance      F_j  the frame's sample, in its channel
#pragma once

#include "image/camera_image.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace aphotic {

// The effect of sources and water on light at one wavelength, apart from geometry: a pixel's
// radiance is a sum of flux reflectance exp(-attenuation path), and of flux exp(-attenuation path)
// for highlights.
struct SourceLight {
    double attenuation_per_m = 0.0;
    std::vector<double> flux{};         // of each strobe, its power included
    std::vector<double> reflectance{};  // of the floor, then of each other material
};

// A veil that POV-Ray renders, in frames of its own, one for each lobe of the water's phase
// functions (spectral/phase_lobes.h).
struct PlannedVeil {
    std::vector<double> scattering_per_m{};  // by lobe; may be negative
    std::array<double, kChannels> weight{};  // of the veil's radiance
    int exposure_log2 = 0;
    double radiance_bound = 0.0;  // relative to the exposed level
};

struct PlannedWavelength {
    double lambda_nm = 0.0;
    std::array<double, kChannels> weight{};  // w_cj
    std::size_t frame = 0;                   // its place among the plan's frames
    std::size_t channel = 0;                 // of the frame, in the order of kChannelNames
    double index_nm = 0.0;                   // of the frame's refractive indices
    SourceLight light{};                     // the light of the rendered frame
    int exposure_log2 = 0;                   // e_j
    double radiance_bound = 0.0;             // of L(lambda_j) in view
    std::optional<PlannedVeil> veil{};       // none: POV-Ray renders no veil
};

}  // namespace aphotic
