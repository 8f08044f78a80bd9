// SPDX-License-Identifier: BSD-3-Clause
//
// COLMAP's cameras.txt and images.txt as COLMAP takes them (3.12: scene/reconstruction_io.cc,
// sensor/models.h), with its formulas written out: nothing here is ours.
#pragma once

#include <gtest/gtest.h>
#include <Eigen/Core>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace aphotic {

struct ColmapText {
    struct Image {
        Eigen::Matrix3d turn;  // world to camera
        Eigen::Vector3d shift_m;
        std::string name{};

        [[nodiscard]] Eigen::Vector3d in_camera(const Eigen::Vector3d& world_m) const {
            return turn * world_m + shift_m;
        }
        [[nodiscard]] Eigen::Vector3d centre_m() const { return -turn.transpose() * shift_m; }
    };
    std::string model{};
    std::vector<double> parameters{};
    std::vector<Image> images{};

    // PINHOLE, OPENCV, FULL_OPENCV and OPENCV_FISHEYE: the pixel of a point in the camera's frame.
    [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& point_m) const {
        const auto k = [&](std::size_t i) { return parameters.at(4 + i); };
        double u = point_m.x() / point_m.z();
        double v = point_m.y() / point_m.z();
        const double r2 = u * u + v * v;
        if (model == "OPENCV_FISHEYE") {
            const double theta = std::atan(std::sqrt(r2));
            const double t2 = theta * theta;
            const double scale =
                theta / std::sqrt(r2) *
                (1.0 + t2 * k(0) + t2 * t2 * k(1) + t2 * t2 * t2 * k(2) + t2 * t2 * t2 * t2 * k(3));
            u *= scale;
            v *= scale;
        } else if (model != "PINHOLE") {
            double radial = 1.0 + k(0) * r2 + k(1) * r2 * r2;
            if (model == "FULL_OPENCV")
                radial = (radial + k(4) * r2 * r2 * r2) /
                         (1.0 + k(5) * r2 + k(6) * r2 * r2 + k(7) * r2 * r2 * r2);
            const double uv = u * v;
            const double du = 2.0 * k(2) * uv + k(3) * (r2 + 2.0 * u * u);
            const double dv = 2.0 * k(3) * uv + k(2) * (r2 + 2.0 * v * v);
            u = u * radial + du;
            v = v * radial + dv;
        }
        return {parameters.at(0) * u + parameters.at(2), parameters.at(1) * v + parameters.at(3)};
    }
};

inline ColmapText read_colmap(const std::string& cameras, const std::string& images) {
    ColmapText read;
    std::string line;
    for (std::istringstream lines(cameras); std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        int camera = 0;
        int width_px = 0;
        int height_px = 0;
        words >> camera >> read.model >> width_px >> height_px;
        for (double number = 0.0; words >> number;) read.parameters.push_back(number);
    }
    for (std::istringstream lines(images); std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        int image = 0;
        int camera = 0;
        double w = 0.0;
        double x = 0.0;
        double y = 0.0;
        double z = 0.0;
        ColmapText::Image& one = read.images.emplace_back();
        words >> image >> w >> x >> y >> z;
        words >> one.shift_m.x() >> one.shift_m.y() >> one.shift_m.z() >> camera >> one.name;
        one.turn << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
            2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y),
            2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
        std::getline(lines, line);  // its points
        EXPECT_EQ(line, "");
    }
    return read;
}

}  // namespace aphotic
