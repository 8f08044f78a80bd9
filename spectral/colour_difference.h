// SPDX-License-Identifier: BSD-3-Clause
//
// Colours as people see them, and how far apart two are.
//
//   CIELAB     L = 116 f(Y/Yn) - 16, a = 500 (f(X/Xn) - f(Y/Yn)), b = 200 (f(Y/Yn) - f(Z/Zn)),
//              f(t) = t^(1/3) above (6/29)^3, else (841/108) t + 4/29; white is D65
//   CIEDE2000  with k_L = k_C = k_H = 1. About 1 is the least that one sees, side by side
//
// Red, green and blue are taken for linear sRGB (IEC 61966-2-1), 1 for white, which is L = 100.
//
// G. Sharma, W. Wu and E. N. Dalal, "The CIEDE2000 color-difference formula: implementation notes,
// supplementary test data, and mathematical observations", Color Research and Application 30(1),
// 21-30 (2005), whose test data it meets to the last digit. Its mean hue jumps where two hues are
// opposite; hues that are opposite but for roundings count as not beyond.
#pragma once

#include <array>

namespace aphotic {

struct Lab {
    double L = 0.0;
    double a = 0.0;
    double b = 0.0;
};

// Of X/Xn, Y/Yn, Z/Zn.
[[nodiscard]] Lab lab_of(const std::array<double, 3>& shares_of_white);
[[nodiscard]] Lab lab_of_srgb(const std::array<double, 3>& linear_rgb);

// Y/Yn of an L, and of a grey the other way round.
[[nodiscard]] double luminance_of(double L);
[[nodiscard]] double lightness_of(double luminance);

[[nodiscard]] double ciede2000(const Lab& one, const Lab& other);

// sRGB's transfer function backwards, from encoded 0..1 to linear.
[[nodiscard]] double srgb_decoded(double encoded);

// Between a colour and grey, as an angle between red, green, blue and 1, 1, 1. 0 to 54.7 degrees of
// a colour that has no negative part; NaN of black.
[[nodiscard]] double degrees_from_grey(const std::array<double, 3>& linear_rgb);

}  // namespace aphotic
