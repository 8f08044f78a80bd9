// SPDX-License-Identifier: BSD-3-Clause
//
// Perceived colours, and the difference between two.
//
//   CIELAB     L = 116 f(Y/Yn) - 16, a = 500 (f(X/Xn) - f(Y/Yn)), b = 200 (f(Y/Yn) - f(Z/Zn)),
//              f(t) = t^(1/3) above (6/29)^3, else (841/108) t + 4/29; white is D65
//   CIEDE2000  with k_L = k_C = k_H = 1. About 1 is just noticeable side by side
//
// Red, green and blue are linear sRGB (IEC 61966-2-1), with 1 for white, which is L = 100.
//
// G. Sharma, W. Wu and E. N. Dalal, "The CIEDE2000 color-difference formula: implementation notes,
// supplementary test data, and mathematical observations", Color Research and Application 30(1),
// 21-30 (2005), whose test data this code reproduces to the last digit. Its mean hue is
// discontinuous where two hues are opposite; hues that are opposite within rounding count as not
// beyond.
#pragma once

#include <array>

namespace aphotic {

struct Lab {
    double L = 0.0;
    double a = 0.0;
    double b = 0.0;
};

// From X/Xn, Y/Yn, Z/Zn.
[[nodiscard]] Lab lab_of(const std::array<double, 3>& shares_of_white);
[[nodiscard]] Lab lab_of_srgb(const std::array<double, 3>& linear_rgb);

// Y/Yn for an L, and the inverse for a grey.
[[nodiscard]] double luminance_of(double L);
[[nodiscard]] double lightness_of(double luminance);

[[nodiscard]] double ciede2000(const Lab& one, const Lab& other);

// Inverse of sRGB's transfer function, from encoded 0..1 to linear.
[[nodiscard]] double srgb_decoded(double encoded);

// The angle between red, green, blue and 1, 1, 1. 0 to 54.7 degrees for a colour without a negative
// component; NaN for black.
[[nodiscard]] double degrees_from_grey(const std::array<double, 3>& linear_rgb);

}  // namespace aphotic
