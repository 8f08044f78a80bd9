// SPDX-License-Identifier: BSD-3-Clause
//
// The loss of light in water.
//
//   K = multiple (a + sum of b_i (1 - F_i(psi_K))) + uniform_loss
//
// K             loss along a path of length l: the share exp(-K l) of the light remains [1/m]
// a             absorption coefficient, a table                                         [1/m]
// b_i, F_i      scattering coefficient of a scatterer, a table, and the share that it
//               scatters within an angle (spectral/phase_function.h)                    [1/m], [1]
// psi_K         kLossCut: light deflected by less counts as not scattered, for it arrives all
//               the same, on its way to the floor, from there to the camera, and in the veil
// multiple      0 is air-like, 0.5 half water, 1 water (the source paper's figure 6)    [1]
// uniform_loss  scattering as one wavelength-free loss (the paper's assumption 1)       [1/m]
//
// K is neither the beam attenuation c = a + b nor the diffuse attenuation K_d of daylight. The cut
// was chosen by comparison with light of all scattering orders (validation/monte_carlo.h); the
// table is in docs/reference/water.md.
//
// With multiple = 0 no table is read, so none need cover the range.
// If K = 0 at every wavelength, as in air, is_clear() holds.
#pragma once

#include "spectral/phase_function.h"
#include "spectral/spectrum.h"

#include <cstddef>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace aphotic {

// [rad]
inline constexpr double kLossCut = 45.0 * std::numbers::pi / 180.0;
// Light deflected by less appears to come from its lamp, and is not part of the veil
// (light/veil.h).
inline constexpr double kVeilCut = 10.0 * std::numbers::pi / 180.0;

// One kind of scatterer: the water itself, or its particles.
struct Scatterer {
    Spectrum scattering_per_m;  // b
    PhaseFunction phase;
};

struct Water {
    Spectrum absorption_per_m;
    double multiple = 1.0;
    double uniform_loss_per_m = 0.0;
    double salinity_psu = 35.0;  // salinity and temperature are for the refractive index only
    double temperature_c = 10.0;
    std::vector<Scatterer> scatterers{};

    [[nodiscard]] double attenuation_per_m(double lambda_nm) const;  // K

    // b_i of one scatterer, multiple included.
    [[nodiscard]] double scattering_per_m(std::size_t scatterer, double lambda_nm) const;

    // No more than K at any wavelength of the tables.
    [[nodiscard]] double least_attenuation_per_m() const;

    [[nodiscard]] bool scatters() const { return multiple != 0.0 && !scatterers.empty(); }
    [[nodiscard]] bool is_clear() const { return multiple == 0.0 && uniform_loss_per_m == 0.0; }

    // The tables from which K is read, valid during the water's lifetime.
    [[nodiscard]] std::vector<const Spectrum*> curves() const;

    // Relative to air.
    [[nodiscard]] double refractive_index(double lambda_nm) const;
    // Waters of the same signature have the same index. By key, as text.
    [[nodiscard]] std::map<std::string, std::string> index_signature() const;
};

}  // namespace aphotic
