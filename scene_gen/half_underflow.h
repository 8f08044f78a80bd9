// SPDX-License-Identifier: BSD-3-Clause
//
// Light that is fainter than frames hold. POV-Ray's colours are floats, which bounds exposures, and
// what a frame holds of L(lambda_j) in view is at most
//
//   2^e_j B_j        B_j  the bound of L(lambda_j)       e_j  the exposure
//
// Below 2^-14 half floats lose digits. Where all light is so faint the image is black, as it should
// be. Where a weight w_cj makes such a wavelength count, |w_cj| B_j against the largest of the
// channel's, beside others that are held, what is lost has no bound.
#pragma once

#include "spectral/planned_wavelength.h"

#include <span>

namespace aphotic {

// Throws InputError where a wavelength counts whose light is not held. What is less than
// frame_error of the largest does not count.
void require_light_that_counts(std::span<const PlannedWavelength> wavelengths, double frame_error);

}  // namespace aphotic
