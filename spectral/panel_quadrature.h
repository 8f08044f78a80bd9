// SPDX-License-Identifier: BSD-3-Clause
//
// Integrals over wavelength for checking a plan, with neither the grid nor the code of the fit
// (spectral/light_family.h).
//
//   int f(lambda) dlambda ~ sum_i width_i f(lambda_i)     f = line line ... line exp(-x)
//
// Between neighbouring knots of all tables, every factor of a signal is a straight line except the
// water's exponential. Over a panel, Gauss's rule of n points is exact for 2n - 1 - p powers of
// that exponential, with p the number of lines; and since no line and no width is negative, its
// error is relative to the panel's integral, however steep the lines are: a filter may rise over
// 300 decades. Over a panel on which x changes by 4, ten points and six lines leave 1e-10.
//
// At the bright end of an interval, panels are this short for the longest path. Farther off, where
// that path's light has fallen by e^-50, they suit shorter paths and grow with the distance. They
// end where the shortest path's light has fallen as much.
#pragma once

#include "spectral/spectrum.h"
#include "spectral/water.h"

#include <span>
#include <vector>

namespace aphotic {

struct QuadratureNode {
    double lambda_nm = 0.0;
    double width_nm = 0.0;
};

// tables: all except the water's. Light travels shortest_path_m to longest_path_m through the
// water. tilt: a further exponent, or null.
[[nodiscard]] std::vector<WavelengthRange> light_panels(std::span<const Spectrum* const> tables,
                                                        const Water& water,
                                                        double shortest_path_m,
                                                        double longest_path_m,
                                                        const Spectrum* tilt,
                                                        WavelengthRange range);

// Ten points in each panel.
[[nodiscard]] std::vector<QuadratureNode> panel_quadrature(std::span<const WavelengthRange> panels);

}  // namespace aphotic
