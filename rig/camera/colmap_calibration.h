// SPDX-License-Identifier: BSD-3-Clause
//
// Cameras in COLMAP's models. COLMAP's cameras.txt has a line for each,
//
//   CAMERA_ID MODEL WIDTH HEIGHT PARAMETERS...
//
// calibmar's calibration.yaml, for underwater cameras, has keys:
//
//   model: OPENCV
//   parameters: [fx, fy, cx, cy, k1, k2, p1, p2]
//   width: 1920
//   height: 1080
//   non_svp_model: NONE, FLATPORT or DOMEPORT
//   non_svp_parameters: [Nx, Ny, Nz, int_dist, int_thick, na, ng, nw] of a flat port,
//                       [Cx, Cy, Cz, int_radius, int_thick, na, ng, nw] of a dome
//
// N is the unit normal, C the dome's centre, X right, Y down, Z along the axis; int_dist is from
// the pupil to the inner face along N, int_radius that of the inner face; all in metres. The
// indices na, ng and nw are not used: a rig specifies its glass and its water.
//
// The first pixel's centre is (0.5, 0.5).
//
// Source: COLMAP 3.12, sensor/models.h; calibmar, core/report.cpp; COLMAP Underwater,
// sensor/models_refrac.h.
#pragma once

#include "rig/camera/calibration_file.h"
#include "rig/camera/calibration_keys.h"

namespace aphotic {

// Whether bytes begin like COLMAP's cameras.bin, which is not supported.
[[nodiscard]] bool is_cameras_bin(std::string_view bytes);

// Whether the first line, apart from comments, begins with a camera's number.
[[nodiscard]] bool is_cameras_txt(std::string_view text);
[[nodiscard]] CameraCalibration parse_cameras_txt(const std::string& file_name,
                                                  std::string_view text);

[[nodiscard]] CameraCalibration read_calibmar_calibration(const CalibrationKeys& keys);

}  // namespace aphotic
