// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/water.h"

#include "spectral/refractive_index.h"

#include <fmt/format.h>

#include <algorithm>

namespace aphotic {

double Water::attenuation_per_m(double lambda_nm) const {
    if (multiple == 0.0) return uniform_loss_per_m;
    double loss = absorption_per_m.at(lambda_nm);
    for (const Scatterer& scatterer : scatterers) {
        loss += scatterer.scattering_per_m.at(lambda_nm) *
                (1.0 - scatterer.phase.share_within(kLossCut));
    }
    return multiple * loss + uniform_loss_per_m;
}

double Water::scattering_per_m(std::size_t scatterer, double lambda_nm) const {
    if (multiple == 0.0) return 0.0;
    return multiple * scatterers[scatterer].scattering_per_m.at(lambda_nm);
}

double Water::least_attenuation_per_m() const {
    if (multiple == 0.0) return uniform_loss_per_m;
    double least = *std::ranges::min_element(absorption_per_m.values());
    for (const Scatterer& scatterer : scatterers) {
        least += *std::ranges::min_element(scatterer.scattering_per_m.values()) *
                 (1.0 - scatterer.phase.share_within(kLossCut));
    }
    return uniform_loss_per_m + multiple * least;
}

std::vector<const Spectrum*> Water::curves() const {
    if (multiple == 0.0) return {};
    std::vector<const Spectrum*> all{&absorption_per_m};
    for (const Scatterer& scatterer : scatterers) all.push_back(&scatterer.scattering_per_m);
    return all;
}

double Water::refractive_index(double lambda_nm) const {
    return seawater_index(lambda_nm, salinity_psu, temperature_c);
}

std::map<std::string, std::string> Water::index_signature() const {
    return {{"water.salinity_psu", fmt::format("{}", salinity_psu)},
            {"water.temperature_c", fmt::format("{}", temperature_c)}};
}

}  // namespace aphotic
