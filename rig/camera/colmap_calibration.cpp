// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/colmap_calibration.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/words.h"
#include "image/image_size.h"
#include "rig/beam/photometric_text.h"
#include "rig/camera/opencv_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// One or two focal lengths, the principal point, and coefficients in OpenCV's order.
struct ColmapModel {
    std::string_view name;
    std::size_t focal_lengths;
    std::size_t coefficients;
    bool is_fisheye;
    std::string_view parameters;
};

constexpr std::array kModels{
    ColmapModel{"SIMPLE_PINHOLE", 1, 0, false, "f, cx, cy"},
    ColmapModel{"PINHOLE", 2, 0, false, "fx, fy, cx, cy"},
    ColmapModel{"SIMPLE_RADIAL", 1, 1, false, "f, cx, cy, k"},
    ColmapModel{"RADIAL", 1, 2, false, "f, cx, cy, k1, k2"},
    ColmapModel{"OPENCV", 2, 4, false, "fx, fy, cx, cy, k1, k2, p1, p2"},
    ColmapModel{"FULL_OPENCV", 2, 8, false, "fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, k5, k6"},
    ColmapModel{"OPENCV_FISHEYE", 2, 4, true, "fx, fy, cx, cy, k1, k2, k3, k4"},
    ColmapModel{"SIMPLE_RADIAL_FISHEYE", 1, 1, true, "f, cx, cy, k"},
    ColmapModel{"RADIAL_FISHEYE", 1, 2, true, "f, cx, cy, k1, k2"}};

std::vector<std::string> model_names() {
    std::vector<std::string> names;
    for (const ColmapModel& model : kModels) names.emplace_back(model.name);
    return names;
}

const ColmapModel* model_named(std::string_view name) {
    const auto* found = std::ranges::find(kModels, name, &ColmapModel::name);
    return found == kModels.end() ? nullptr : found;
}

void require_parameters(const ColmapModel& model, std::size_t count) {
    const std::size_t wanted = model.focal_lengths + 2 + model.coefficients;
    if (count == wanted) return;
    throw InputError("found {}; allowed for {}: {}, which are {}",
                     counted(count, "number"),
                     model.name,
                     wanted,
                     model.parameters);
}

LensModel lens_of(const ColmapModel& model, std::span<const double> parameters) {
    require_parameters(model, parameters.size());
    LensModel lens;
    lens.is_fisheye = model.is_fisheye;
    lens.focal_px = {parameters[0], parameters[model.focal_lengths - 1]};
    parameters = parameters.subspan(model.focal_lengths);
    lens.centre_px = {parameters[0], parameters[1]};
    set_opencv_coefficients(lens, parameters.subspan(2));
    return lens;
}

struct CameraLine {
    std::size_t line = 0;
    std::vector<std::string_view> words;
};

// Up to two lines that describe a camera, to detect more than one.
std::vector<CameraLine> first_cameras(std::string_view text) {
    std::vector<CameraLine> cameras;
    for (std::size_t line = 1; !text.empty() && cameras.size() < 2; ++line) {
        const std::vector<std::string_view> words = words_in(next_line(text));
        if (!words.empty() && !words.front().starts_with('#')) cameras.push_back({line, words});
    }
    return cameras;
}

// Limits as for rigs, in metres (rig_reader.cpp).
constexpr double kLeastPort_m = 0.001;
constexpr double kMostPort_m = 10.0;
constexpr double kMostThickness_m = 1.0;
constexpr double kMostTilt_rad = std::numbers::pi / 3.0;

// From X right, Y down, Z along the axis; without negative zeros.
Vector3d in_sled(double X, double Y, double Z) {
    return Vector3d(-Y, X, Z) + Vector3d::Zero();
}

Vector3d normal_of(const CalibrationKeys& keys, const Vector3d& normal) {
    constexpr double kUnit = 1e-3;  // calibmar writes six digits
    const double length = normal.norm();
    if (std::abs(length - 1.0) > kUnit || normal.z() < std::cos(kMostTilt_rad) * length) {
        keys.fail("non_svp_parameters",
                  fmt::format("found the normal [{}, {}, {}]; allowed: a unit vector within 60 "
                              "degrees of [0, 0, 1]",
                              normal.y(),
                              -normal.x() + 0.0,
                              normal.z()));
    }
    return normal / length;
}

CalibratedPort port_of(const CalibrationKeys& keys, bool is_dome) {
    const std::string key = "non_svp_parameters";
    const std::vector<double> parameters = keys.numbers(key, 8);
    const auto length_m = [&](std::size_t i, std::string_view name, double most_m) {
        if (parameters[i] < kLeastPort_m || parameters[i] > most_m) {
            keys.fail(key,
                      fmt::format("found {} {}; allowed: {} to {}, in metres",
                                  name,
                                  parameters[i],
                                  kLeastPort_m,
                                  most_m));
        }
        return parameters[i];
    };
    const Vector3d vector = in_sled(parameters[0], parameters[1], parameters[2]);
    CalibratedPort port;
    if (is_dome) {
        port.dome = Dome{.centre_m = vector, .radius_m = length_m(3, "int_radius", kMostPort_m)};
        if (vector.norm() >= port.dome->radius_m) {
            keys.fail(key,
                      fmt::format("found the centre {} m from the pupil; allowed: within "
                                  "int_radius, {} m",
                                  vector.norm(),
                                  port.dome->radius_m));
        }
    } else {
        port.distance_m = length_m(3, "int_dist", kMostPort_m);
        port.normal = normal_of(keys, vector);
    }
    port.thickness_m = length_m(4, "int_thick", kMostThickness_m);
    return port;
}

}  // namespace

bool is_cameras_txt(std::string_view text) {
    const std::vector<CameraLine> cameras = first_cameras(text);
    if (cameras.empty()) return false;
    const std::string_view id = cameras.front().words.front();
    return id.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_cameras_bin(std::string_view bytes) {
    // The number of cameras, then for each its number, its model's, width, height and three
    // parameters or more: little-endian, of 8, 4, 4, 8, 8, 8 bytes.
    constexpr std::size_t kLeastBytes = 56;
    if (bytes.size() < kLeastBytes) return false;
    const auto number = [&](std::size_t at, std::size_t length) {
        std::uint64_t value = 0;
        for (std::size_t i = length; i-- > 0;)
            value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
        return value;
    };
    constexpr std::uint64_t kMostCameras = 1'000'000;
    constexpr std::uint64_t kMostModels = 100;
    constexpr std::uint64_t kMostPixels = kLargestImagePx;
    const auto is_up_to = [](std::uint64_t value, std::uint64_t most) {
        return value >= 1 && value <= most;
    };
    return is_up_to(number(0, 8), kMostCameras) && number(12, 4) <= kMostModels &&
           is_up_to(number(16, 8), kMostPixels) && is_up_to(number(24, 8), kMostPixels);
}

CameraCalibration parse_cameras_txt(const std::string& file_name, std::string_view text) {
    const std::vector<CameraLine> cameras = first_cameras(text);
    if (cameras.size() > 1) {
        fail_at_line(
            file_name, cameras[1].line, "found a second camera; allowed: one, that of the rig");
    }
    const std::size_t line = cameras.front().line;
    const std::vector<std::string_view>& words = cameras.front().words;
    if (words.size() < 4) {
        fail_at_line(file_name,
                     line,
                     "found {}; allowed: CAMERA_ID MODEL WIDTH HEIGHT PARAMETERS",
                     counted(words.size(), "word"));
    }
    const ColmapModel* model = model_named(words[1]);
    if (model == nullptr) {
        fail_at_line(file_name,
                     line,
                     "model: found {}; allowed: {}",
                     shown_word(words[1]),
                     fmt::join(model_names(), ", "));
    }
    const auto size = [&](std::string_view word, std::string_view what) {
        return static_cast<int>(
            count_of(file_name, number_of(file_name, line, word, what), what, 1, kLargestImagePx));
    };
    CameraCalibration made{.width_px = size(words[2], "width"),
                           .height_px = size(words[3], "height")};
    std::vector<double> parameters;
    for (std::size_t i = 4; i < words.size(); ++i)
        parameters.push_back(number_of(file_name, line, words[i], "parameters").value);
    made.lens = naming(fmt::format("{}:{}: parameters", file_name, line),
                       [&] { return lens_of(*model, parameters); });
    return made;
}

CameraCalibration read_calibmar_calibration(const CalibrationKeys& keys) {
    const ColmapModel& model = *model_named(keys.word("model", model_names()));
    CameraCalibration made{.width_px = keys.size("width"), .height_px = keys.size("height")};
    const std::vector<double> parameters = keys.numbers("parameters");
    try {
        made.lens = lens_of(model, parameters);
    } catch (const InputError& error) {
        keys.fail("parameters", error.what());
    }
    if (!keys.has("non_svp_model")) return made;
    const std::string port = keys.word("non_svp_model", {"NONE", "FLATPORT", "DOMEPORT"});
    if (port != "NONE") made.port = port_of(keys, port == "DOMEPORT");
    return made;
}

}  // namespace aphotic
