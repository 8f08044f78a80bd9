// SPDX-License-Identifier: BSD-3-Clause
//
// The matrix from a camera's channels to sRGB, which makes a corrected image viewable.
//
// An image divided by its light holds in each channel the reflectance as that channel sees it. In
// sRGB, a surface should look as it does under daylight:
//
//   v_c = int rho E Q_c dlambda / int E Q_c dlambda
//   t   = A^-1 X,   X = int rho D (xbar, ybar, zbar) dlambda / int D ybar dlambda
//   M   = argmin sum over surfaces |M v - t|^2,   each row of M adding up to 1
//
// rho   reflectance of a surface; outside its table, the value at the table's end     [1]
// E     light on its way from the lamps to the camera, relative
// Q_c   the camera's response (sensor.h)
// D     CIE standard illuminant D65, xbar ... the CIE 1931 2-degree observer, over 380 to 780 nm
// A     the XYZ of sRGB's primaries, as columns, such that (1, 1, 1) is the XYZ of D65
// M     the matrix; t linear sRGB
//
// Integrals are sums over whole nanometres. The surfaces are a colour chart's 24 patches and the
// built-in reflectances. Since the rows add up to 1, grey stays grey and white white, exactly. If
// channels are indistinguishable, the result is the best matrix nearest the identity.
//
// The remaining error is the distance in CIELAB (CIE 1976) between M v and t, with white D65. No
// matrix is exact unless the camera's responses are the observer's.
//
// Primaries: IEC 61966-2-1:1999. Rows that keep white: G. D. Finlayson and M. S. Drew, "Constrained
// least-squares regression in color spaces", Journal of Electronic Imaging 6(4), 484-493 (1997).
#pragma once

#include "spectral/curve_loader.h"
#include "spectral/sensor.h"

#include <Eigen/Core>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

struct ShownSurface {
    std::string name;
    Eigen::Vector3d channels;  // v
    Eigen::Vector3d srgb;      // t, linear
    double delta_e = 0.0;      // the error of M v
};

struct CameraToSrgb {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
    std::vector<ShownSurface> surfaces{};  // used for the fit

    [[nodiscard]] double mean_delta_e() const;
    [[nodiscard]] const ShownSurface& worst() const;
};

// light: E over the range's wavelengths. An InputError if a channel receives no light.
[[nodiscard]] CameraToSrgb camera_to_srgb(const Sensor& sensor,
                                          WavelengthRange range,
                                          const std::function<double(double lambda_nm)>& light);

// The colour chart: scenes/user/chart/patches.
[[nodiscard]] std::span<const BuiltinTable> chart_patches();

}  // namespace aphotic
