// SPDX-License-Identifier: BSD-3-Clause
//
// The veil (light/veil.h) of a render's image, which is added to the light of POV-Ray's frames:
//
//   S_c         = sum_j w_cj 2^-e_j F_j + V_c
//   L(lambda_j) = 2^-e_j F_j + A(lambda_j)
//
// V_c  the veil in channel c: an integral over the whole spectrum (light/veil_map.h), not over the
//      wavelengths of the frames, which are chosen for the floor's light alone
// A    the veil at one wavelength, along its own ray, whichever ray its frame has
//
// Both are planes of one file (veil_path() of spectral/manifest.h), of floats, up to the surface
// that the pixel sees: the rig's floor, or the distance from the frame of fog
// (spectral/manifest.h), to a half float's precision. Shadows in the veil are omitted. The error is
// at most veil_plane_error() of a pixel's signal over the floor, as measured; it is not a bound. It
// is from the interpolation, and from kVeilMapPoints per panel, or kVeilPoints if these are not
// accurate to a tenth of kVeilOfSignal.
#pragma once

#include "light/path_range.h"
#include "rig/rig.h"
#include "spectral/manifest.h"

#include <array>
#include <filesystem>
#include <optional>

namespace aphotic {

// For a veil without frames of its own. Throws InputError if something other than the bare floor is
// in view.
void require_bare_floor_under_veil(const Rig& rig);

[[nodiscard]] double veil_plane_error(const Rig& rig);

// The quality of a rule for the sum, for channels that see any light.
[[nodiscard]] std::array<RuleQuality, kChannels> with_veil(
    std::array<RuleQuality, kChannels> quality, double veil_error);

// Writes veil_path(folder) for the manifest's wavelengths, in blocks of rows, with as many threads;
// returns the manifest's record of it: empty, and no file, if the water does not scatter.
std::optional<ManifestVeil> write_veil(const std::filesystem::path& folder,
                                       const Rig& rig,
                                       const Manifest& manifest,
                                       int threads);

// The same for R, G and B only.
std::optional<ManifestVeil> write_veil_of_signals(const std::filesystem::path& folder,
                                                  const Rig& rig,
                                                  const Manifest& manifest,
                                                  int threads);

}  // namespace aphotic
