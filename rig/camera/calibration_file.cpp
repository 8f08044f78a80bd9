// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/calibration_file.h"

#include "base/error.h"
#include "base/file_kind.h"
#include "rig/beam/photometric_text.h"
#include "rig/camera/calibration_keys.h"
#include "rig/camera/colmap_calibration.h"
#include "rig/camera/opencv_calibration.h"

#include <fmt/format.h>

namespace aphotic {

namespace {

constexpr std::string_view kKnownCalibrations =
    "camera_matrix (OpenCV, ROS), cam0 (Kalibr), model and parameters (calibmar), <calibration> "
    "(Metashape), or lines of COLMAP's cameras.txt";

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

// cam0, cam1, ...
bool names_camera(std::string_view name) {
    return name.size() > 3 && name.starts_with("cam") &&
           name.find_first_not_of("0123456789", 3) == std::string_view::npos;
}

std::vector<std::string> cameras_of(const CalibrationKeys& keys) {
    std::vector<std::string> cameras = keys.names();
    std::erase_if(cameras, [](const std::string& name) { return !names_camera(name); });
    return cameras;
}

bool is_camchain(const CalibrationKeys& keys) {
    return !cameras_of(keys).empty();
}

CameraCalibration read_kalibr_calibration(const CalibrationKeys& keys) {
    const std::vector<std::string> cameras = cameras_of(keys);
    if (cameras.size() > 1) {
        keys.fail(cameras[1],
                  fmt::format("found together with {}; allowed: one camera, that of the rig",
                              cameras[0]));
    }
    const CalibrationKeys camera = keys.map(cameras.front());
    const std::vector<double> resolution = camera.numbers("resolution", 2);
    CameraCalibration made{.width_px = camera.size("resolution", resolution[0]),
                           .height_px = camera.size("resolution", resolution[1])};
    static_cast<void>(camera.word("camera_model", {"pinhole"}));
    const std::vector<double> intrinsics = camera.numbers("intrinsics", 4);
    made.lens.focal_px = {intrinsics[0], intrinsics[1]};
    made.lens.centre_px = from_pixel_centres(intrinsics[2], intrinsics[3]);
    const std::string model = camera.word("distortion_model", {"radtan", "equidistant", "none"});
    if (model == "none") return made;
    made.lens.is_fisheye = model == "equidistant";
    set_opencv_coefficients(made.lens, camera.numbers("distortion_coeffs", 4));
    return made;
}

// Metashape's calibration in its own XML: <calibration> with projection (frame or fisheye), width,
// height, f, cx, cy, b1, b2, k1 to k4, p1, p2. With (x, y) = (X, Y)/Z, or of a fisheye (X, Y) over
// hypot(X, Y) times the angle off the axis,
//
//   x'     = x (1 + k1 r^2 + ... + k4 r^8) + p1 (r^2 + 2 x^2) + 2 p2 x y
//   y'     = y (1 + k1 r^2 + ... + k4 r^8) + p2 (r^2 + 2 y^2) + 2 p1 x y
//   column = width/2 + cx + x' (f + b1) + y' b2
//   row    = height/2 + cy + y' f
//
// so p1 is LensModel's p2 and vice versa. The first pixel's centre is (0.5, 0.5). Missing values
// are 0, except for size, projection and f, which are required; p3 and p4 must be 0.
//
// Source: Agisoft Metashape Pro 2.1, User Manual, Appendix D, "Camera models".
CameraCalibration read_metashape_calibration(const CalibrationKeys& keys) {
    const auto or_zero = [&](std::string_view key) { return keys.number_or(key, 0.0); };
    for (const std::string_view key : {"p3", "p4"}) {
        if (or_zero(key) != 0.0) keys.fail(key, fmt::format("found {}; allowed: 0", or_zero(key)));
    }
    CameraCalibration made{.width_px = keys.size("width"), .height_px = keys.size("height")};
    LensModel& lens = made.lens;
    lens.is_fisheye = keys.word("projection", {"frame", "fisheye"}) == "fisheye";
    const double f = keys.number("f");
    lens.focal_px = {f + or_zero("b1"), f};
    lens.centre_px = {0.5 * made.width_px + or_zero("cx"), 0.5 * made.height_px + or_zero("cy")};
    lens.skew_px = or_zero("b2");
    lens.radial = {or_zero("k1"), or_zero("k2"), or_zero("k3"), or_zero("k4")};
    lens.tangential = {or_zero("p2"), or_zero("p1")};
    return made;
}

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
            "COLMAP writes with: colmap model_converter --input_path MODEL --output_path TEXT "
            "--output_type TXT",
            file_name);
    }
    const std::string_view kind = binary_kind(text);
    if (kind.empty() && text.find('\0') == std::string_view::npos) return;
    throw InputError("{}: found {}; allowed, as text: {}",
                     file_name,
                     kind.empty() ? "zero bytes" : kind,
                     kKnownCalibrations);
}

void require_within(
    const std::string& file_name, std::string_view what, double value, double least, double most) {
    if (value >= least && value <= most) return;
    throw InputError(
        "{}: {}: found {}; allowed: a number from {} to {}", file_name, what, value, least, most);
}

// Refuses numbers from which no lens can be computed.
void require_sound(const std::string& file_name, const LensModel& lens) {
    // The range of focal_length_mm over pixel_pitch_um.
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
