// SPDX-License-Identifier: BSD-3-Clause
//
// The family of light (spectral/light_family.h) that a rig's camera can see: every lamp's spectrum
// on every material, and the bare spectrum if the floor has a highlight, over the paths of
// light/path_range.h.
//
// Behind a port, each wavelength shows its own point of the floor: the family's tilt is the largest
// change of light from the middle wavelength's point to it, over the image. Diffuse light and
// highlight, and lamps of different spectra, change independently, each weighted by its share. On
// objects, whose surfaces turn away from the light and end, the change is unbounded: there it
// counts up to kObjectTilt, growing with the shift of the image, and pixels with more are among the
// edges, to which the promise does not apply.
#pragma once

#include "light/path_range.h"
#include "rig/rig.h"
#include "spectral/light_family.h"
#include "spectral/planned_wavelength.h"

#include <vector>

namespace aphotic {

// Logarithm of a change of light.
inline constexpr double kObjectTilt = 0.05;

// Places along the width or height of an image where the light behind a port is sampled [pixel]:
// the middle of every pixel, or kMostPlaces evenly from the first to the last. A beam's table may
// be steep over an angle as narrow as its rows, which fewer places would miss.
[[nodiscard]] std::vector<double> places_along(int pixels);
inline constexpr int kMostPlaces = 65;

// Lamps with the same spectrum are merged, and so are materials.
[[nodiscard]] LightFamily light_family(const Rig& rig);

// The materials for which the rig's light is planned, in this order: the floor's, the further ones,
// the objects'.
[[nodiscard]] std::vector<Spectrum> materials_of(const Rig& rig);

// At one wavelength, in the order of the rig's strobes and of materials_of().
[[nodiscard]] SourceLight source_light(const Rig& rig, double lambda_nm);

// The same family with one set of sources per strobe, in their order: each material and, if
// anything has a highlight, the bare lamp.
[[nodiscard]] LightFamily light_family_by_strobe(const Rig& rig);

}  // namespace aphotic
