// SPDX-License-Identifier: BSD-3-Clause
//
// The wavelengths at which the reference takes its integrals over the spectrum. The plan has a grid
// of its own (spectral/light_family.h), and neither knows the other's.
//
//   S_c = int L Q_c dlambda ~ sum_j w_cj L(lambda_j)
//
// Between neighbouring knots of all tables each factor of L Q_c is a straight line, but for the
// water's exponential, and ten of Gauss's points are right to 1e-10 where that falls by e^-4 at
// most: an interval over which it falls farther is cut. Each panel gets the fewest points by which
// no channel's signal of any of the lights is off what ten make of it by more than the panel's
// share of `error`; a spent one gets none. Lights: every source, over kPaths paths in even ratios
// from the shortest to the longest; the veil's as well, where the water scatters.
#pragma once

#include "spectral/bands.h"
#include "spectral/light_family.h"
#include "spectral/sensor.h"

#include <vector>

namespace aphotic {

inline constexpr int kPaths = 7;

// The veil's light: b_i for a reflectance, and paths of its own. None: no sources.
struct VeilLights {
    std::vector<std::vector<Spectrum>> sources{};
    double shortest_path_m = 0.0;
    double longest_path_m = 0.0;
};

// Of a family without a tilt.
[[nodiscard]] std::vector<WeightedWavelength> full_spectrum(const Sensor& sensor,
                                                            const LightFamily& lights,
                                                            WavelengthRange range,
                                                            double error,
                                                            const VeilLights& veil = {});

}  // namespace aphotic
