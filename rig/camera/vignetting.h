// SPDX-License-Identifier: BSD-3-Clause
//
// The falloff of a lens towards the image's corners: the factor V of every pixel's signal, the same
// for all wavelengths.
//
//   Natural     V = cos^n theta, n = 4 by default     theta: the pixel's angle off the axis in air
//   Radial      V = 1 + a1 p^2 + a2 p^4 + a3 p^6      p: distance from the principal point over
//                                                     half the image's diagonal
//   Tabulated   V over theta, straight lines between rows
//
// On the axis V is 1, unless a table gives another value. Radial is the form of panorama tools. The
// reference has its own V (validation/).
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace aphotic {

struct Camera;

struct NaturalVignetting {
    double exponent = 4.0;  // n

    bool operator==(const NaturalVignetting&) const = default;
};

struct RadialVignetting {
    std::array<double, 3> a{};

    bool operator==(const RadialVignetting&) const = default;
};

struct TabulatedVignetting {
    std::vector<double> angles_rad;  // increasing, from 0
    std::vector<double> factors;

    bool operator==(const TabulatedVignetting&) const = default;
};

using Vignetting = std::variant<NaturalVignetting, RadialVignetting, TabulatedVignetting>;

// p^2 of the point (column, row) of the image.
[[nodiscard]] double radial_square(const Camera& camera, double column, double row);

// V at the point (column, row) of the image; 1 without vignetting.
[[nodiscard]] double vignetting_at(const Camera& camera, double column, double row);

// The radial form closest to the camera's own over its image; 0 without vignetting.
[[nodiscard]] RadialVignetting radial_like(const Camera& camera);

// At every pixel's centre, row by row.
[[nodiscard]] std::vector<float> vignetting_plane(const Camera& camera);

// An InputError, which names the pixel, unless V is above 0 over the whole image and a table
// extends as far.
void require_bright(const Camera& camera);

// A table from CSV, with the header angle_deg,factor: angles increase from 0, factors are above 0.
[[nodiscard]] TabulatedVignetting parse_vignetting_csv(const std::string& file_name,
                                                       std::string_view text);

// Equal signatures mean equal vignetting for the same camera.
[[nodiscard]] std::string vignetting_signature(const Vignetting& vignetting);

}  // namespace aphotic
