// SPDX-License-Identifier: BSD-3-Clause
//
// OpenCV's calibrations, as its FileStorage writes them, and ROS's camera_info:
//
//   image_width, image_height
//   camera_matrix             data of 3 x 3: fx 0 cx, 0 fy cy, 0 0 1
//   distortion_coefficients   data: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tx ty]]]]; of a fisheye
//                             k1 k2 k3 k4
//   distortion_model          plumb_bob, rational_polynomial, equidistant or fisheye; optional
//   fisheye_model             1 for a fisheye; optional
//
// The first pixel's centre is (0, 0). k4 to k6 are LensModel's q1 to q3. Thin prisms s and a tilted
// sensor t must be 0.
//
// Source: OpenCV 4.6, "Camera Calibration and 3D Reconstruction"; samples/cpp/calibration.cpp; ROS,
// sensor_msgs/CameraInfo.
#pragma once

#include "rig/camera/calibration_file.h"
#include "rig/camera/calibration_keys.h"

#include <Eigen/Core>

#include <span>

namespace aphotic {

[[nodiscard]] CameraCalibration read_opencv_calibration(const CalibrationKeys& keys);

// k1 k2 p1 p2 k3 k4 k5 k6, or k1 k2 k3 k4 of a fisheye; missing ones are 0.
void set_opencv_coefficients(LensModel& lens, std::span<const double> coefficients);

// For a point where the first pixel's centre is (0, 0).
[[nodiscard]] Eigen::Vector2d from_pixel_centres(double column, double row);

}  // namespace aphotic
