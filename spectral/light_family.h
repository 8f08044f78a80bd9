// SPDX-License-Identifier: BSD-3-Clause
//
// The spectra that a scene's light can have, and their integration over wavelength.
//
// Light that reaches the camera has travelled a path of length l and was reflected by one material:
//
//   f(lambda) = source(lambda) exp(-K(lambda) l),      T_c(l) = int f Q_c dlambda
//
// source  lamp spectrum, times the floor's reflectance (for a highlight, the lamp's alone)
// K       loss of the water [1/m]        l  lamp to floor to camera, in water [m]
// Q_c     response of channel c          T_c  signal of such light
//
// Behind a dispersing port, every wavelength sees a different point of the floor, which may be lit
// more or less by up to a factor exp(tilt(lambda)): f then includes exp(t tilt), t from -1 to 1.
//
// A pixel's signal is a sum of such T_c with non-negative factors. A rule of wavelengths and
// weights that errs by at most e on every member of the family therefore errs by at most e on every
// pixel.
#pragma once

#include "spectral/bands.h"
#include "spectral/sensor.h"
#include "spectral/spectrum.h"
#include "spectral/water.h"

#include <optional>
#include <vector>

namespace aphotic {

struct LightFamily {
    // Each source is the product of its curves.
    std::vector<std::vector<Spectrum>> sources{};
    Water water;
    double shortest_path_m = 0.0;
    double longest_path_m = 0.0;
    std::optional<Spectrum> tilt{};  // empty without a port
};

// An integration grid that is exact to the given error for every member of the family: between
// neighbouring knots of all tables each factor is a straight line, and Gauss-Legendre with as many
// points as the interval needs integrates their product. Summed over the intervals, the differences
// from a rule of kExactPoints points stay under `error` times the channel's T_c, on kExactPaths
// paths from the shortest to the longest, in even ratios. An interval over which the longest path's
// light falls too steeply for that rule is cut into several.
[[nodiscard]] std::vector<WeightedWavelength> reference_grid(const Sensor& sensor,
                                                             const LightFamily& family,
                                                             WavelengthRange range,
                                                             double error);
inline constexpr unsigned kExactPoints = 12;
inline constexpr int kExactPaths = 5;

}  // namespace aphotic
