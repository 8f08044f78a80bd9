// SPDX-License-Identifier: BSD-3-Clause
#include "rig/calibration_file.h"

#include "base/error.h"
#include "base/file_kind.h"
#include "rig/calibration_keys.h"
#include "rig/colmap_calibration.h"
#include "rig/kalibr_calibration.h"
#include "rig/metashape_calibration.h"
#include "rig/opencv_calibration.h"
#include "rig/photometric_text.h"

#include <cmath>

namespace aphotic {

namespace {

constexpr std::string_view kKnownCalibrations =
    "camera_matrix (OpenCV, ROS), cam0 (Kalibr), model and parameters (calibmar), <calibration> "
    "(Metashape), or lines of COLMAP's cameras.txt";

CameraCalibration read_xml(const std::string& file_name, std::string_view text) {
    const CalibrationValue root = parse_calibration_xml(file_name, text);
    const CalibrationKeys keys(file_name, root);
    if (root.name == "calibration") return read_metashape_calibration(keys);
    if (root.name == "opencv_storage") return read_opencv_calibration(keys);
    fail_at_line(file_name,
                 root.line,
                 "found the element {}; allowed: calibration (Metashape) or opencv_storage "
                 "(OpenCV)",
                 shown_word(root.name));
}

CameraCalibration read_yaml(const std::string& file_name, std::string_view text) {
    const CalibrationValue root = parse_calibration_yaml(file_name, text);
    const CalibrationKeys keys(file_name, root);
    if (keys.has("camera_matrix")) return read_opencv_calibration(keys);
    if (keys.has("model")) return read_calibmar_calibration(keys);
    if (is_camchain(keys)) return read_kalibr_calibration(keys);
    throw InputError("{}: found no camera; allowed: {}", file_name, kKnownCalibrations);
}

CameraCalibration read_any(const std::string& file_name, std::string_view text) {
    if (is_cameras_txt(text)) return parse_cameras_txt(file_name, text);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool is_xml = first != std::string_view::npos && text[first] == '<';
    return is_xml ? read_xml(file_name, text) : read_yaml(file_name, text);
}

void require_text(const std::string& file_name, std::string_view text) {
    if (is_cameras_bin(text)) {
        throw InputError(
            "{}: found COLMAP's cameras.bin, which is binary; allowed: its cameras.txt, which "
            "COLMAP makes of it: colmap model_converter --input_path MODEL --output_path TEXT "
            "--output_type TXT",
            file_name);
    }
    const std::string_view kind = binary_kind(text);
    if (kind.empty() && text.find('\0') == std::string_view::npos) return;
    throw InputError("{}: found {}; allowed, as text: {}",
                     file_name,
                     kind.empty() ? "zero bytes, which no text has" : kind,
                     kKnownCalibrations);
}

void require_within(
    const std::string& file_name, std::string_view what, double value, double least, double most) {
    if (value >= least && value <= most) return;
    throw InputError(
        "{}: {}: found {}; allowed: a number from {} to {}", file_name, what, value, least, most);
}

// Numbers with which the lens can be worked out, whatever their format.
void require_sound(const std::string& file_name, const LensModel& lens) {
    // What focal_length_mm over pixel_pitch_um can be.
    constexpr double kLeastFocal_px = 1e-3;
    constexpr double kMostFocal_px = 1e10;
    constexpr double kMost = 1e9;
    const auto require = [&](std::string_view what, double value) {
        require_within(file_name, what, value, -kMost, kMost);
    };
    for (const double focal_px : lens.focal_px) {
        require_within(
            file_name, "focal length in pixels", focal_px, kLeastFocal_px, kMostFocal_px);
    }
    for (const double at_px : lens.centre_px) require("principal point", at_px);
    require("skew", lens.skew_px);
    for (const double k : lens.radial) require("radial coefficient", k);
    for (const double q : lens.radial_below) require("radial coefficient", q);
    for (const double p : lens.tangential) require("tangential coefficient", p);
}

}  // namespace

CameraCalibration parse_calibration(const std::string& file_name, std::string_view text) {
    require_text(file_name, text);
    CameraCalibration calibration = read_any(file_name, utf8_of(text));
    require_sound(file_name, calibration.lens);
    return calibration;
}

}  // namespace aphotic
