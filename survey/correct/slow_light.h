// SPDX-License-Identifier: BSD-3-Clause
//
// Corrections of uneven light that assume only that the lamps' light changes slowly over the image:
// common practice without a model, for comparison. Each works on one plane of samples, a channel or
// the sites of one colour of a mosaic, and keeps its brightness, so that f(k I) = k f(I).
//
//   divided by a pattern        I / max(p, kLeastShare mean p)  mean p
//     illumination-reflectance    p = G I, the image itself smoothed
//     log-polynomial              p = exp(P), P fitted to the mean of log I over many images
//     altitude-binned polynomial  p = P, fitted to the images of one bin of altitude
//   homomorphic                 log out = l_mean + low (G l - l_mean) + high (l - G l)
//   local equalisation          see below
//
// G  a Gaussian blur      P  a polynomial over the image (polynomial_surface.h)
// l  log max(I, kBlackShare mean I), so that black has a logarithm
// low, high  the gains of slow and quick changes: 0 and 1 remove everything slow, 1 and 1 change
//            nothing
//
// Limits: the first and the last two treat any broad variation as light, be it a lamp's pattern or
// a pale patch of sand, and level the channels separately, so colour is lost as well. The fitted
// ones are limited to patterns that their polynomials can follow, which excludes the edge of a
// cone. A polynomial can fall to 0 or below; the lower limit of the pattern bounds its gain to
// 1 / kLeastShare.
//
// R. Garcia, T. Nicosevici and X. Cufi, "On the way to solve lighting problems in underwater
// imaging", OCEANS 2002 (illumination-reflectance, homomorphic, local equalisation); H. Singh,
// C. Roman, O. Pizarro, R. Eustice and A. Can, "Towards high-resolution imaging from underwater
// vehicles", Int. J. Robotics Research 26(1), 2007 (log-polynomial).
#pragma once

#include <span>
#include <vector>

namespace aphotic {

// A plane of samples smoothed by a Gaussian of any width, in a time independent of that width.
//
//   g = e_L * e_L * e_L * e_L * e_L * f      along the rows, then along the columns
//
// e_L is a box whose length L need not be whole: its two end samples carry a fraction, chosen so
// that the five together have exactly the variance sigma^2. The result deviates from the Gaussian
// by at most 3.5 % of its peak. Beyond its border the image is mirrored, so that nothing darkens
// there: a constant stays unchanged, and the mean is kept.
//
// P. Gwosdek, S. Grewenig, A. Bruhn and J. Weickert, "Theoretical foundations of Gaussian
// convolution by extended box filtering", SSVM 2011, LNCS 6667.

// plane: rows of width_px samples, all finite; sigma_px > 0.
[[nodiscard]] std::vector<float> gaussian_blur(std::span<const float> plane,
                                               int width_px,
                                               double sigma_px);

[[nodiscard]] double mean_of(std::span<const float> plane);

inline constexpr double kLeastShare = 0.01;
inline constexpr double kBlackShare = 1e-3;

[[nodiscard]] std::vector<float> divided_by_pattern(std::span<const float> plane,
                                                    std::span<const float> pattern);

[[nodiscard]] std::vector<float> illumination_reflectance(std::span<const float> plane,
                                                          int width_px,
                                                          double sigma_px);

struct Homomorphic {
    double sigma_px = 1.0;
    double low = 0.0;
    double high = 1.0;
};
[[nodiscard]] std::vector<float> homomorphic(std::span<const float> plane,
                                             int width_px,
                                             const Homomorphic& filter);

// l of every sample, 0 where the plane's mean is not above 0.
[[nodiscard]] std::vector<float> logarithms(std::span<const float> plane);
[[nodiscard]] std::vector<float> exponentials(std::span<const float> plane);

// Contrast-limited adaptive histogram equalisation: every part of the image is given the same
// distribution of brightness, whatever its light.
//
//   out = least + (most - least) F(I)
//
// F            the share of samples below I in the surrounding tile; interpolated linearly between
//              the centres of tiles, constant beyond the outermost
// least, most  of the plane: out stays within them, and f(k I) = k f(I)
// clip         no bin counts for more than clip times the mean bin, and the excess is spread over
//              all bins: 1 leaves the image unchanged, without a limit F is the tile's own
//
// Bins are kBins between least and most, and F is linear within a bin. A constant stays unchanged.
// The tone curve is nonlinear, so the result is not a measurement; and a pale patch as large as a
// tile is removed with the light.
//
// K. Zuiderveld, "Contrast limited adaptive histogram equalization", Graphics Gems IV, 1994.

inline constexpr int kBins = 1024;

struct LocalEqualisation {
    int tiles = 8;  // across and down
    double clip = 3.0;
};

// plane: rows of width_px samples, all finite. An InputError when there are more tiles than rows or
// columns.
[[nodiscard]] std::vector<float> locally_equalised(std::span<const float> plane,
                                                   int width_px,
                                                   const LocalEqualisation& options);

}  // namespace aphotic
