// SPDX-License-Identifier: BSD-3-Clause
//
// A plane of samples smoothed by a Gaussian of any width, in a time that does not depend on it.
//
//   g = e_L * e_L * e_L * e_L * e_L * f      along the rows, then along the columns
//
// e_L is a box whose length L need not be whole: its two end samples carry a fraction, chosen so
// that the five together have the variance sigma^2 exactly. What they make is a bell within 3.5 %
// of the Gaussian's peak. Beyond its border the image goes on mirrored, so that nothing
// gets darker there: a constant stays what it is, and the mean is kept.
//
// P. Gwosdek, S. Grewenig, A. Bruhn and J. Weickert, "Theoretical foundations of Gaussian
// convolution by extended box filtering", SSVM 2011, LNCS 6667.
#pragma once

#include <span>
#include <vector>

namespace aphotic {

// plane: rows of width_px samples, all finite; sigma_px > 0.
[[nodiscard]] std::vector<float> gaussian_blur(std::span<const float> plane,
                                               int width_px,
                                               double sigma_px);

}  // namespace aphotic
