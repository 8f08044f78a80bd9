// SPDX-License-Identifier: BSD-3-Clause
//
// Metashape's calibration in its own XML: <calibration> with projection (frame or fisheye), width,
// height, f, cx, cy, b1, b2, k1 to k4, p1, p2. With (x, y) = (X, Y)/Z, or of a fisheye (X, Y) over
// hypot(X, Y) times the angle off the axis,
//
//   x'     = x (1 + k1 r^2 + ... + k4 r^8) + p1 (r^2 + 2 x^2) + 2 p2 x y
//   y'     = y (1 + k1 r^2 + ... + k4 r^8) + p2 (r^2 + 2 y^2) + 2 p1 x y
//   column = width/2 + cx + x' (f + b1) + y' b2
//   row    = height/2 + cy + y' f
//
// so p1 is LensModel's p2 and the other way round. The first pixel's centre is (0.5, 0.5). What is
// missing but for size, projection and f is 0; p3 and p4 must be.
//
// Source: Agisoft Metashape Pro 2.1, User Manual, Appendix D, "Camera models".
#pragma once

#include "rig/calibration_file.h"
#include "rig/calibration_keys.h"

namespace aphotic {

[[nodiscard]] CameraCalibration read_metashape_calibration(const CalibrationKeys& keys);

}  // namespace aphotic
