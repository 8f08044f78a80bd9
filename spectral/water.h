// SPDX-License-Identifier: BSD-3-Clause
//
// How much light a metre of this water takes away.
//
//   K(lambda) = multiple * a(lambda) + uniform_loss
//
// K             loss along a path of length l: the light that is left is exp(-K l)     [1/m]
// a             absorption coefficient of the water, a table                           [1/m]
// multiple      0 is air-like, 0.5 half water, 1 water (the source paper's figure 6)   [1]
// uniform_loss  scattering as one wavelength-free loss (the paper's assumption 1)      [1/m]
//
// With multiple = 0 the table is never read, so it need not cover the range.
// K = 0 at every wavelength is bare air: is_clear() holds.
#pragma once

#include "spectral/spectrum.h"

#include <map>
#include <string>
#include <vector>

namespace aphotic {

struct Water {
    Spectrum absorption_per_m;
    double multiple = 1.0;
    double uniform_loss_per_m = 0.0;
    double salinity_psu = 35.0;  // it and the temperature are for the refractive index only
    double temperature_c = 10.0;

    [[nodiscard]] double attenuation_per_m(double lambda_nm) const {
        const double absorbed = multiple == 0.0 ? 0.0 : multiple * absorption_per_m.at(lambda_nm);
        return absorbed + uniform_loss_per_m;
    }

    // No more than K at any wavelength of the table.
    [[nodiscard]] double least_attenuation_per_m() const;

    [[nodiscard]] bool is_clear() const { return multiple == 0.0 && uniform_loss_per_m == 0.0; }

    // The tables that K is read from, as long as the water lives.
    [[nodiscard]] std::vector<const Spectrum*> curves() const;

    // Relative to air.
    [[nodiscard]] double refractive_index(double lambda_nm) const;
    // Waters of the same signature have the same index; by key, as words and numbers.
    [[nodiscard]] std::map<std::string, std::string> index_signature() const;
};

}  // namespace aphotic
