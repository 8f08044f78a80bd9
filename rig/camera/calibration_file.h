// SPDX-License-Identifier: BSD-3-Clause
//
// Other tools' camera calibrations, recognised by their contents:
//
//   FileStorage of OpenCV (YAML, XML, JSON), camera_info of ROS   rig/camera/opencv_calibration.h
//   camchain of Kalibr                                            rig/camera/calibration_file.cpp
//   cameras.txt of COLMAP, calibration.yaml of calibmar           rig/camera/colmap_calibration.h
//   calibration in XML of Metashape                               rig/camera/calibration_file.cpp
//
// Each of these files states where its format has the centre of the first pixel; here it is (0.5,
// 0.5). A file describes one camera. An error is an InputError "file:line: key: what was found;
// allowed: ...".
#pragma once

#include "rig/camera/lens_model.h"
#include "rig/camera/port.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

// A port without its glass, for which a calibration gives only one index.
struct CalibratedPort {
    double distance_m = 0.0;  // as in PortWindow, in the sled's frame
    double thickness_m = 0.0;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    std::optional<Dome> dome{};

    bool operator==(const CalibratedPort&) const = default;
};

struct CameraCalibration {
    int width_px = 0;
    int height_px = 0;
    LensModel lens{};  // in the air behind a port
    std::optional<CalibratedPort> port{};

    bool operator==(const CameraCalibration&) const = default;
};

// The limit allows for OpenCV's list of all detected corners.
inline constexpr std::size_t kMostCalibrationBytes = std::size_t{2} << 20U;

// file_name is for messages. Values are in range, but need not be valid over the whole image:
// lens_model.h.
[[nodiscard]] CameraCalibration parse_calibration(const std::string& file_name,
                                                  std::string_view text);

}  // namespace aphotic
