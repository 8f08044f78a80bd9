// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/lens.h"
#include "rig/file/rig_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace aphotic::lens_test {
namespace {

constexpr double kRounding = 1e-15;

// 1360 x 1024 pixels of 6.45 um behind 12 mm.
Camera habcam() {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml").camera;
}

TEST(Lens, LooksAlongTheAxisInTheMiddleAndForwardToStarboardAtTheTopRight) {
    const Camera camera = habcam();
    EXPECT_EQ(direction_in_air(camera, 680.0, 512.0), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d corner = direction_in_air(camera, 1360.0, 0.0);
    EXPECT_NEAR(corner.norm(), 1.0, kRounding);
    EXPECT_NEAR(corner.x() / corner.z(), 512.0 * 6.45e-6 / 12e-3, kRounding);
    EXPECT_NEAR(corner.y() / corner.z(), 680.0 * 6.45e-6 / 12e-3, kRounding);
    EXPECT_NEAR(half_view_rad(camera), std::acos(corner.z()), 1e-14);
}

TEST(Lens, ShowsPointsBetweenItsCorners) {
    const Camera camera = habcam();
    const double half_m = 2.0 * 680.0 * 6.45e-6 / 12e-3;  // across, at 2 m
    EXPECT_TRUE(is_in_view(camera, {0.0, half_m - 1e-6, 2.0}, 1.0));
    EXPECT_FALSE(is_in_view(camera, {0.0, half_m + 1e-6, 2.0}, 1.0));
    EXPECT_TRUE(is_in_view(camera, {0.0, 1.49 * half_m, 2.0}, 1.5));
    EXPECT_FALSE(is_in_view(camera, {0.0, 0.0, -2.0}, 1.5));
}

TEST(Lens, SignatureIsOfAllThatBendsItsRays) {
    const auto before = lens_signature(habcam());
    for (const auto& change : {+[](Camera& c) { c.width_px += 1; },
                               +[](Camera& c) { c.height_px += 1; },
                               +[](Camera& c) { c.pixel_pitch_m *= 1.0 + 1e-12; },
                               +[](Camera& c) { c.focal_length_m *= 1.0 + 1e-12; }}) {
        Camera camera = habcam();
        change(camera);
        EXPECT_NE(lens_signature(camera), before);
    }
}

}  // namespace
}  // namespace aphotic::lens_test
