// SPDX-License-Identifier: BSD-3-Clause
//
// The wavelengths in a spectral image's channel names, in the layout of Fichet, Pacanowski and
// Wilkie ("An OpenEXR layout for spectral images", JCGT 10(3), 2021). A name is a quantity and one
// wavelength, or two of a bispectral reflectance, parted by points: S0.550,000000nm, S0.5,5E2nm,
// T.0,55um, S1.545THz, T.400nm.550nm. A number has a comma for its point and may have any number of
// digits; its unit is m or Hz after an SI prefix. So writers spell one channel in many ways.
#pragma once

#include <string_view>

namespace aphotic {

// Wavelengths that writers round to three decimals of a nanometre, as pbrt does, are within it.
inline constexpr double kSameWavelength_nm = 1e-3;

// Whether the names are of one quantity at wavelengths of which each is within
// kSameWavelength_nm of its own in the other. False when a name holds no wavelength.
[[nodiscard]] bool is_same_spectral_channel(std::string_view a, std::string_view b);

}  // namespace aphotic
