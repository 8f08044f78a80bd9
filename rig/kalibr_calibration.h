// SPDX-License-Identifier: BSD-3-Clause
//
// Kalibr's camchain:
//
//   cam0:
//     camera_model: pinhole
//     intrinsics: [fu, fv, pu, pv]
//     distortion_model: radtan (k1, k2, p1, p2 of OpenCV), equidistant (its fisheye) or none
//     distortion_coeffs: [k1, k2, p1, p2] or [k1, k2, k3, k4]
//     resolution: [width, height]
//
// The first pixel's centre is (0, 0). Other models are refused, and so is a chain of several
// cameras.
//
// Source: Kalibr's wiki, "Yaml formats", "Supported models"; ethz-asl/kalibr issue 115.
#pragma once

#include "rig/calibration_file.h"
#include "rig/calibration_keys.h"

namespace aphotic {

[[nodiscard]] bool is_camchain(const CalibrationKeys& keys);
[[nodiscard]] CameraCalibration read_kalibr_calibration(const CalibrationKeys& keys);

}  // namespace aphotic
