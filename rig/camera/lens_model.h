// SPDX-License-Identifier: BSD-3-Clause
//
// A lens as in calibrations: the point of the image where light from a direction arrives.
//
//   (a, b)  = (X, Y) / Z                       rectilinear
//           = (X, Y) theta / hypot(X, Y)       fisheye; theta: angle off the axis
//   r^2     = a^2 + b^2
//   s       = (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) / (1 + q1 r^2 + q2 r^4 + q3 r^6)
//   a'      = s a + 2 p1 a b + p2 (r^2 + 2 a^2)
//   b'      = s b + p1 (r^2 + 2 b^2) + 2 p2 a b
//   column  = fx a' + skew b' + cx
//   row     = fy b' + cy
//
// (X, Y, Z) is the direction in the camera frame: X right, Y down, Z along the axis; in the sled's,
// X = y, Y = -x, Z = z (rig.h). k, q, p are dimensionless, all else is in pixels. The centre of the
// first pixel is (0.5, 0.5): OpenCV's centres are whole numbers, so its cx and cy are half a pixel
// less.
//
// The model is valid as far from the axis as s r increases with r, and below 90 degrees.
//
// With all coefficients 0 it is a pinhole, or an equidistant fisheye. OpenCV's plumb bob is k1, k2,
// p1, p2, k3; its rational model has q1 to q3 for k4 to k6; its fisheye is k1 to k4 of a fisheye.
// Source: OpenCV 4.6, "Camera Calibration and 3D Reconstruction" and "Fisheye camera model".
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct LensModel {
    Eigen::Vector2d focal_px = Eigen::Vector2d::Zero();   // fx, fy
    Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // cx, cy
    double skew_px = 0.0;
    bool is_fisheye = false;
    std::array<double, 4> radial{};        // k1 ... k4
    std::array<double, 3> radial_below{};  // q1 ... q3
    std::array<double, 2> tangential{};    // p1, p2

    bool operator==(const LensModel&) const = default;
};

// The point (column, row) where light from the direction (X, Y, Z) arrives. Z > 0.
[[nodiscard]] Eigen::Vector2d image_point(const LensModel& lens, const Eigen::Vector3d& direction);

// The unit direction of the light that arrives at (column, row), to 1e-14; empty where the model is
// not valid.
[[nodiscard]] std::optional<Eigen::Vector3d> direction_at(const LensModel& lens,
                                                          const Eigen::Vector2d& point_px);

// Points along the four sides of an image, a 64th of a side apart.
[[nodiscard]] std::vector<Eigen::Vector2d> rim_px(int width_px, int height_px);

// An InputError, which names the angle, unless the model is valid over the whole image.
void require_to_hold(const LensModel& lens, int width_px, int height_px);

// No coefficients, no skew, square pixels, and the axis in the image's middle.
[[nodiscard]] bool is_pinhole(const LensModel& lens, int width_px, int height_px);

// Lenses of the same signature have the same view.
[[nodiscard]] std::string lens_model_signature(const LensModel& lens);

}  // namespace aphotic
