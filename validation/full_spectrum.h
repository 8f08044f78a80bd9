// SPDX-License-Identifier: BSD-3-Clause
//
// The wavelengths at which the reference computes its integrals over the spectrum. The plan has its
// own grid (spectral/light_family.h), independent of this one.
//
//   S_c = int L Q_c dlambda ~ sum_j w_cj L(lambda_j)
//
// Between neighbouring knots of all tables each factor of L Q_c is a straight line except the
// water's exponential, and ten Gauss points are accurate to 1e-10 if that falls by at most e^-4: an
// interval over which it falls further is cut. Each panel gets the fewest points for which no
// channel's signal, for any of the lights, differs from that of ten by more than the panel's share
// of `error`; a panel without light gets none. Lights: every source, over kPaths paths in even
// ratios from the shortest to the longest; the veil's as well, if the water scatters.
#pragma once

#include "spectral/bands.h"
#include "spectral/light_family.h"
#include "spectral/sensor.h"

#include <vector>

namespace aphotic {

inline constexpr int kPaths = 7;

// The veil's light: b_i in place of a reflectance, with its own paths. Empty without sources.
struct VeilLights {
    std::vector<std::vector<Spectrum>> sources{};
    double shortest_path_m = 0.0;
    double longest_path_m = 0.0;
};

// The family must have no tilt.
[[nodiscard]] std::vector<WeightedWavelength> full_spectrum(const Sensor& sensor,
                                                            const LightFamily& lights,
                                                            WavelengthRange range,
                                                            double error,
                                                            const VeilLights& veil = {});

}  // namespace aphotic
