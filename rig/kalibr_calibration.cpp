// SPDX-License-Identifier: BSD-3-Clause
#include "rig/kalibr_calibration.h"

#include "image/image_size.h"
#include "rig/opencv_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace aphotic {

namespace {

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

void read_resolution(const CalibrationKeys& camera, CameraCalibration& made) {
    const std::vector<double> resolution = camera.numbers("resolution", 2);
    for (const double pixels : resolution) {
        if (pixels >= 1.0 && pixels <= kLargestImagePx && pixels == std::floor(pixels)) continue;
        camera.fail(
            "resolution",
            fmt::format("found {}; allowed: whole numbers from 1 to {}", pixels, kLargestImagePx));
    }
    made.width_px = static_cast<int>(resolution[0]);
    made.height_px = static_cast<int>(resolution[1]);
}

}  // namespace

bool is_camchain(const CalibrationKeys& keys) {
    return !cameras_of(keys).empty();
}

CameraCalibration read_kalibr_calibration(const CalibrationKeys& keys) {
    const std::vector<std::string> cameras = cameras_of(keys);
    if (cameras.size() > 1) {
        keys.fail(cameras[1],
                  fmt::format("found beside {}; allowed: one camera, that of the rig", cameras[0]));
    }
    const CalibrationKeys camera = keys.map(cameras.front());
    CameraCalibration made;
    read_resolution(camera, made);
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

}  // namespace aphotic
