// SPDX-License-Identifier: BSD-3-Clause
//
// Natural waters as absorption and scatterers: sea water itself, and its particles.
//
// By type: a and b of a table of role "water type", water included, as the sources measured or
// inferred them for Jerlov's types. Their wavelengths are coarse, and their a is below pure water's
// in the red, so they provide only the dissolved and suspended matter, and water's own tables the
// water:
//
//   a = a_w + max(0, a_type - a_w)         b_particles = max(0, b_type - b_sw)
//
// By constituents, for waters whose optical properties all follow from chlorophyll (case 1), Chl
// [mg/m^3]:
//
//   a   = a_w + 0.06 A(lambda) Chl^0.65 + a_440 exp(-0.014 (lambda - 440))
//   b_p = particles 0.416 Chl^0.766 (lambda/550)^v
//   v   = (log10 Chl - 0.3)/2, and 0 from Chl = 2 on
//   b_b/b of the particles = 0.002 + 0.01 (1/2 - log10(Chl)/4)
//
// a_w     pure water: 'pure-2016'           b_sw  sea water: seawater_scattering.h
// A       of phytoplankton, 1 at 440 nm     a_440 of dissolved matter; if not given: a fifth of
//                                                 the rest at 440 nm, as in case 1
// Chl is from kLeastChlorophyll to kMostChlorophyll, where the formulas were fitted. The particles'
// phase function is that of Fournier and Forand for this b_b/b.
//
// Absorption: L. Prieur and S. Sathyendranath, Limnology and Oceanography 26, 671 (1981), and A.
// Morel, Progress in Oceanography 26, 263 (1991), after C. D. Mobley, Light and Water (1994), eq.
// 3.27 and table 3.7. Scattering: H. Loisel and A. Morel, Limnology and Oceanography 43, 847
// (1998); A. Morel and S. Maritorena, J. Geophysical Research 106, 7163 (2001).
#pragma once

#include "spectral/water.h"

#include <optional>

namespace aphotic {

inline constexpr double kLeastChlorophyll = 0.02;
inline constexpr double kMostChlorophyll = 30.0;

struct Constituents {
    double chlorophyll_mg_m3 = 0.0;
    std::optional<double> cdom_440_per_m{};
    double particles = 1.0;
};

// a_440 in case 1, used if none is given.
[[nodiscard]] double case_1_cdom_440_per_m(double chlorophyll_mg_m3);

// Sea water alone, over the range of its refractive index.
[[nodiscard]] Scatterer seawater_scatterer(double salinity_psu, double temperature_c);

// absorption and scattering: those of a water type.
void take_type(const Spectrum& absorption,
               const Spectrum& scattering,
               const PhaseFunction& particles,
               Water& water);

void take_constituents(const Constituents& constituents, Water& water);

}  // namespace aphotic
