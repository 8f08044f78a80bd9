// SPDX-License-Identifier: BSD-3-Clause
#include "light/dispersion.h"

#include "rig/geometry.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace aphotic::dispersion_test {
namespace {

// A pixel covers 1/n of the floor that it covers without a port, and n of 400 nm is 1.1 % more than
// that of 720 nm: so much it matters whose pixels are counted. A third of it again, for pixels
// towards the corner cover ever less.
constexpr double kWhosePixels = 0.015;

TEST(CornerShift, IsZeroWithoutAPort) {
    const Rig rig = scene_rig("habcam.toml");
    EXPECT_EQ(corner_shift_px(rig, 400.0, 720.0), 0.0);
    EXPECT_EQ(corner_shift_px(rig, 650.0, 450.0), 0.0);
}

// docs/background/physics.md: 6.1 pixels in the corners of scenes/port.toml, on a level floor at 2
// m.
TEST(CornerShift, HasTheFigureOfTheManual) {
    constexpr double kTwoDigits = 0.05;
    EXPECT_NEAR(corner_shift_px(scene_rig("port.toml"), 450.0, 650.0), 6.1, kTwoDigits);
}

// Column at which the ray of a wavelength meets the plane at the altitude this far from the axis,
// along the image's diagonal, by bisection; in pixels from the middle.
double radius_px(const Rig& rig, double from_axis_m, double lambda_nm) {
    const Camera& camera = rig.camera;
    const double half_px = 0.5 * std::hypot(camera.width_px, camera.height_px);
    double low = 0.0;
    double high = 2.0 * half_px;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        const double share = middle / half_px;
        const WaterRay ray = pixel_ray(rig,
                                       0.5 * camera.width_px * (1.0 - share),
                                       0.5 * camera.height_px * (1.0 - share),
                                       lambda_nm);
        const double down_m = (rig.sled.altitude_m - ray.origin_m.z()) / ray.direction.z();
        const Eigen::Vector3d point_m = ray.origin_m + down_m * ray.direction;
        (point_m.head<2>().norm() < from_axis_m ? low : high) = middle;
    }
    return low;
}

// What the formula stands for: how many pixels apart a floor point appears in the two.
TEST(CornerShift, IsHowFarApartAPointAppears) {
    const Rig rig = scene_rig("port.toml");
    for (const double blue_nm : {400.0, 450.0, 520.0}) {
        for (const double red_nm : {560.0, 650.0, 720.0}) {
            const WaterRay corner = pixel_ray(rig, 0.0, 0.0, red_nm);
            const double down_m =
                (rig.sled.altitude_m - corner.origin_m.z()) / corner.direction.z();
            const double from_axis_m =
                (corner.origin_m + down_m * corner.direction).head<2>().norm();
            const double apart_px =
                radius_px(rig, from_axis_m, blue_nm) - radius_px(rig, from_axis_m, red_nm);
            EXPECT_NEAR(corner_shift_px(rig, blue_nm, red_nm) / apart_px, 1.0, kWhosePixels)
                << blue_nm << " against " << red_nm << " nm: " << apart_px << " pixels";
        }
    }
}

// Light that is a parabola in the index is that at all wavelengths.
TEST(IndexNodes, AreExactForAParabola) {
    constexpr double kRounding = 1e-9;
    const Rig rig = scene_rig("port.toml");
    const std::vector<double> nodes_nm = index_nodes_nm(rig);
    ASSERT_EQ(nodes_nm.size(), kIndexNodes);
    const auto light = [&](double nm) {
        const double n = 100.0 * (rig.water.refractive_index(nm) - 1.34);
        return 2.0 - n + 3.0 * n * n;
    };
    for (const double nm : {400.0, 433.0, 550.0, 601.5, 720.0}) {
        double sum = 0.0;
        for (std::size_t j = 0; j < nodes_nm.size(); ++j)
            sum += index_share(rig, nodes_nm, j, nm) * light(nodes_nm[j]);
        EXPECT_NEAR(sum, light(nm), kRounding) << nm;
    }
}

TEST(IndexNodes, WithoutAPortOneIsEnough) {
    const Rig rig = scene_rig("habcam.toml");
    EXPECT_FALSE(disperses(rig));
    const std::vector<double> nodes_nm = index_nodes_nm(rig);
    ASSERT_EQ(nodes_nm.size(), 1U);
    EXPECT_EQ(index_share(rig, nodes_nm, 0, 600.0), 1.0);
}

}  // namespace
}  // namespace aphotic::dispersion_test
