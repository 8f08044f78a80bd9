// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/colour_difference.h"

#include "base/degrees.h"

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

constexpr double kKnee = 6.0 / 29.0;

double lab_curve(double t) {
    return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
}

// In degrees, 0 to 360; 0 if there is no hue.
double hue_deg(double a, double b) {
    if (a == 0.0 && b == 0.0) return 0.0;
    const double hue = std::atan2(b, a) * kDegreesPerRadian;
    return hue < 0.0 ? hue + 360.0 : hue;
}

double cos_deg(double angle_deg) {
    return std::cos(angle_deg * kRadiansPerDegree);
}

double to_the_7th(double value) {
    return std::pow(value, 7);
}

// sqrt(C^7 / (C^7 + 25^7))
double chroma_share(double chroma) {
    return std::sqrt(to_the_7th(chroma) / (to_the_7th(chroma) + to_the_7th(25.0)));
}

}  // namespace

Lab lab_of(const std::array<double, 3>& shares_of_white) {
    const double x = lab_curve(shares_of_white[0]);
    const double y = lab_curve(shares_of_white[1]);
    const double z = lab_curve(shares_of_white[2]);
    return {.L = 116.0 * y - 16.0, .a = 500.0 * (x - y), .b = 200.0 * (y - z)};
}

Lab lab_of_srgb(const std::array<double, 3>& linear_rgb) {
    constexpr std::array<std::array<double, 3>, 3> kXyz{
        {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
    std::array<double, 3> shares{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& [r, g, b] = kXyz[i];
        const double value = r * linear_rgb[0] + g * linear_rgb[1] + b * linear_rgb[2];
        shares[i] = value / (r + g + b);
    }
    return lab_of(shares);
}

double luminance_of(double L) {
    const double t = (L + 16.0) / 116.0;
    return t > kKnee ? t * t * t : 3.0 * kKnee * kKnee * (t - 4.0 / 29.0);
}

double lightness_of(double luminance) {
    return 116.0 * lab_curve(luminance) - 16.0;
}

double ciede2000(const Lab& one, const Lab& other) {
    const double mean_chroma = (std::hypot(one.a, one.b) + std::hypot(other.a, other.b)) / 2.0;
    const double stretch = 1.5 - 0.5 * chroma_share(mean_chroma);  // 1 + G
    const double a1 = stretch * one.a;
    const double a2 = stretch * other.a;
    const double C1 = std::hypot(a1, one.b);
    const double C2 = std::hypot(a2, other.b);
    const double h1 = hue_deg(a1, one.b);
    const double h2 = hue_deg(a2, other.b);
    const bool has_hues = C1 * C2 > 0.0;
    constexpr double kHalf_deg = 180.0 + 1e-9;  // allows for rounding of opposite hues

    double dh = has_hues ? h2 - h1 : 0.0;
    if (dh > kHalf_deg) dh -= 360.0;
    if (dh < -kHalf_deg) dh += 360.0;
    const double lightness_step = other.L - one.L;
    const double chroma_step = C2 - C1;
    const double hue_step = 2.0 * std::sqrt(C1 * C2) * std::sin(0.5 * dh * kRadiansPerDegree);

    const double L = (one.L + other.L) / 2.0;
    const double C = (C1 + C2) / 2.0;
    double h = has_hues ? (h1 + h2) / 2.0 : h1 + h2;
    if (has_hues && std::abs(h1 - h2) > kHalf_deg) h += h1 + h2 < 360.0 ? 180.0 : -180.0;

    const double T = 1.0 - 0.17 * cos_deg(h - 30.0) + 0.24 * cos_deg(2.0 * h) +
                     0.32 * cos_deg(3.0 * h + 6.0) - 0.20 * cos_deg(4.0 * h - 63.0);
    const double off_blue = (h - 275.0) / 25.0;
    const double turn_deg = 60.0 * std::exp(-off_blue * off_blue);  // 2 dtheta
    const double off_middle = (L - 50.0) * (L - 50.0);
    const double per_l = 1.0 + 0.015 * off_middle / std::sqrt(20.0 + off_middle);
    const double per_c = 1.0 + 0.045 * C;
    const double per_h = 1.0 + 0.015 * C * T;
    const double rotation = -2.0 * chroma_share(C) * std::sin(turn_deg * kRadiansPerDegree);
    const double l = lightness_step / per_l;
    const double c = chroma_step / per_c;
    const double s = hue_step / per_h;
    return std::sqrt(std::max(0.0, l * l + c * c + s * s + rotation * c * s));
}

double srgb_decoded(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double degrees_from_grey(const std::array<double, 3>& linear_rgb) {
    const auto [r, g, b] = linear_rgb;
    // By the cross product with 1, 1, 1, since the cosine is inaccurate for small angles.
    const double across = std::hypot(g - b, b - r, r - g);
    const double along = r + g + b;
    if (across == 0.0 && along == 0.0) return std::nan("");
    return std::atan2(across, along) * kDegreesPerRadian;
}

}  // namespace aphotic
