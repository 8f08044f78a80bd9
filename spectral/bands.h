// SPDX-License-Identifier: BSD-3-Clause
//
// Wavelengths that represent the spectrum, and their weights.
//
//   S_c = int L(lambda) Q_c(lambda) dlambda  ~  sum_j w_cj L(lambda_j)
//
// S_c  signal of channel c       L  spectral radiance       Q_c  response of the sensor
//
// equal_bands(n) is the midpoint rule: n bands of equal width over the range, lambda_j the
// middle of band j, w_cj = width * Q_c(lambda_j). Its error falls with the square of the width.
#pragma once

#include "spectral/sensor.h"
#include "spectral/spectrum.h"

#include <array>
#include <span>
#include <vector>

namespace aphotic {

struct WeightedWavelength {
    double lambda_nm = 0.0;
    std::array<double, kChannels> weight{};  // w_cj [nm x unit of Q_c]
};

[[nodiscard]] std::vector<WeightedWavelength> equal_bands(const Sensor& sensor,
                                                          WavelengthRange range,
                                                          int count);

// Throws InputError unless the wavelengths are increasing and lie within the range.
void require_wavelengths(WavelengthRange range, std::span<const double> lambda_nm);

}  // namespace aphotic
