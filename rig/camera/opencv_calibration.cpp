// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/opencv_calibration.h"

#include "base/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace aphotic {

namespace {

constexpr std::size_t kMostCoefficients = 8;  // thin prisms and tilts follow

// The numbers of coefficients that OpenCV allows.
std::vector<std::size_t> counts_of(std::string_view model) {
    if (model == "plumb_bob") return {4, 5};
    if (model == "rational_polynomial") return {8, 12, 14};
    if (model == "fisheye") return {4};
    return {4, 5, 8, 12, 14};
}

// Empty if the file names none.
std::string model_of(const CalibrationKeys& keys) {
    std::string model;
    if (keys.has("distortion_model")) {
        model = keys.word("distortion_model",
                          {"plumb_bob", "rational_polynomial", "equidistant", "fisheye"});
        if (model == "equidistant") model = "fisheye";
    }
    if (keys.number_or("fisheye_model", 0.0) != 0.0) {
        if (!model.empty() && model != "fisheye")
            keys.fail("fisheye_model",
                      "found together with distortion_model; allowed: one of them");
        model = "fisheye";
    }
    return model;
}

void read_matrix(const CalibrationKeys& matrix, LensModel& lens) {
    const std::vector<double> K = matrix.numbers("data", 9);
    // OpenCV's projection ignores K[1], a skew.
    constexpr std::array<std::size_t, 4> kZeros{1, 3, 6, 7};
    for (const std::size_t i : kZeros) {
        if (K[i] != 0.0)
            matrix.fail("data",
                        fmt::format("found [{}]; allowed: [fx, 0, cx, 0, fy, cy, 0, 0, 1]",
                                    fmt::join(K, ", ")));
    }
    if (K[8] != 1.0)
        matrix.fail("data", fmt::format("found {} as the last number; allowed: 1", K[8]));
    lens.focal_px = {K[0], K[4]};
    lens.centre_px = from_pixel_centres(K[2], K[5]);
}

void read_coefficients(const CalibrationKeys& matrix, std::string_view model, LensModel& lens) {
    const std::vector<double> all = matrix.numbers("data");
    const std::vector<std::size_t> counts = counts_of(model);
    if (std::ranges::find(counts, all.size()) == counts.end()) {
        matrix.fail("data",
                    fmt::format("found {}; allowed{}: {}",
                                counted(all.size(), "number"),
                                model.empty() ? "" : fmt::format(" for {}", model),
                                fmt::join(counts, ", ")));
    }
    const std::span<const double> known(all.data(), std::min(all.size(), kMostCoefficients));
    const bool is_known = std::all_of(all.begin() + static_cast<std::ptrdiff_t>(known.size()),
                                      all.end(),
                                      [](double c) { return c == 0.0; });
    if (!is_known) {
        matrix.fail("data",
                    "found a thin prism or a tilted sensor; allowed: 0 for the coefficients after "
                    "the eighth");
    }
    set_opencv_coefficients(lens, known);
}

}  // namespace

Eigen::Vector2d from_pixel_centres(double column, double row) {
    return {column + 0.5, row + 0.5};
}

void set_opencv_coefficients(LensModel& lens, std::span<const double> coefficients) {
    auto& [k1, k2, k3, k4] = lens.radial;
    auto& [q1, q2, q3] = lens.radial_below;
    auto& [p1, p2] = lens.tangential;
    const std::array<double*, 4> fisheye{&k1, &k2, &k3, &k4};
    const std::array<double*, 8> rectilinear{&k1, &k2, &p1, &p2, &k3, &q1, &q2, &q3};
    for (std::size_t i = 0; i < coefficients.size(); ++i)
        *(lens.is_fisheye ? fisheye.at(i) : rectilinear.at(i)) = coefficients[i];
}

CameraCalibration read_opencv_calibration(const CalibrationKeys& keys) {
    CameraCalibration made{.width_px = keys.size("image_width"),
                           .height_px = keys.size("image_height")};
    const std::string model = model_of(keys);
    made.lens.is_fisheye = model == "fisheye";
    read_matrix(keys.map("camera_matrix"), made.lens);
    read_coefficients(keys.map("distortion_coefficients"), model, made.lens);
    return made;
}

}  // namespace aphotic
