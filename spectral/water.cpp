// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/water.h"

#include "spectral/refractive_index.h"

#include <fmt/format.h>

#include <algorithm>

namespace aphotic {

double Water::least_attenuation_per_m() const {
    if (multiple == 0.0) return uniform_loss_per_m;
    return uniform_loss_per_m + multiple * *std::ranges::min_element(absorption_per_m.values());
}

std::vector<const Spectrum*> Water::curves() const {
    if (multiple == 0.0) return {};
    return {&absorption_per_m};
}

double Water::refractive_index(double lambda_nm) const {
    return seawater_index(lambda_nm, salinity_psu, temperature_c);
}

std::map<std::string, std::string> Water::index_signature() const {
    return {{"water.salinity_psu", fmt::format("{}", salinity_psu)},
            {"water.temperature_c", fmt::format("{}", temperature_c)}};
}

}  // namespace aphotic
