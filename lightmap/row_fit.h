// SPDX-License-Identifier: BSD-3-Clause
//
// Smooth quantities along a block of a row's pixels, from few of them: a polynomial of kFitDegree
// in the pixel's number, by least squares through kFitSamples pixels that lie as Chebyshev's points
// do, close together at both ends. Samples are twice as many as the polynomial needs, so that what
// it is off by between them shows at them. Where it is off by more than is asked, there is no fit,
// and who asks computes pixel by pixel.
#pragma once

#include "lightmap/direction_block.h"

#include <array>

namespace aphotic {

inline constexpr std::size_t kFitDegree = 8;
inline constexpr std::size_t kFitSamples = 16;

// The samples' pixels, from the block's first to its last.
[[nodiscard]] const std::array<std::size_t, kFitSamples>& fit_pixels();

// The directions at the samples, which come first.
void take_samples(const DirectionBlock& V, bool has_sides, DirectionBlock& samples);

// The polynomial at every pixel, or false: by absolute error, and by error relative to the sample.
[[nodiscard]] bool fit(const RowBlock<double>& samples,
                       double absolute,
                       double relative,
                       RowBlock<double>& values);

// The block's values from those of kFitSamples pixels, which are above 0: false where there is no
// fit within kRowFitError of each, which is a few roundings of floats.
inline constexpr double kRowFitError = 1e-6;
[[nodiscard]] bool fit(const float* samples, RowBlock<float>& values);

}  // namespace aphotic
