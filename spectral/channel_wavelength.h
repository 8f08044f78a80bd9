// SPDX-License-Identifier: BSD-3-Clause
//
// The wavelengths in a spectral image's channel names, in the layout of Fichet, Pacanowski and
// Wilkie ("An OpenEXR layout for spectral images", JCGT 10(3), 2021). A name is a quantity and one
// wavelength, or two for a bispectral reflectance, separated by points: S0.550,000000nm,
// S0.5,5E2nm, T.0,55um, S1.545THz, T.400nm.550nm. A number has a decimal comma and any number of
// digits; its unit is m or Hz with an SI prefix. One channel therefore has many spellings.
#pragma once

#include <string_view>

namespace aphotic {

// Covers wavelengths that writers such as pbrt round to three decimals of a nanometre.
inline constexpr double kSameWavelength_nm = 1e-3;

// Whether the names have the same quantity and wavelengths within kSameWavelength_nm of each other.
// False if a name has no wavelength.
[[nodiscard]] bool is_same_spectral_channel(std::string_view a, std::string_view b);

}  // namespace aphotic
