// SPDX-License-Identifier: BSD-3-Clause
//
// Frames can be reused: new weights turn the frames of one rig into the image of another that
// differs in water, lamps, materials or sensor, but not in geometry (rig/geometry_signature.h).
//
//   S_c = sum_j w_cj L_j,   w fitted to the changed rig's signals on the basis of the frames' light
//
// A frame holds Phi_s rho exp(-K l) of its own rig, recorded in its manifest for each wavelength,
// strobe and material; over the paths that the geometry allows, sums of such exponentials span
// others. The error is determined and promised as for any plan (spectral/quadrature_fit.h).
#pragma once

#include "scene_gen/render_plan.h"
#include "spectral/manifest.h"

namespace aphotic {

// For frames of a user's scene, `changed` is rig_of_scene() of the changed rig.
//
// The manifest with the weights, promises and names of the changed rig. Throws InputError if the
// geometry differs, with the difference, and if the promise exceeds the tolerance, with the
// wavelengths whose frames are missing.
[[nodiscard]] Manifest reintegrate(const Rig& changed, const Manifest& manifest, double tolerance);

}  // namespace aphotic
