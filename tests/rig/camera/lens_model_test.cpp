// SPDX-License-Identifier: BSD-3-Clause
//
// The formula of calibrated lenses: its closed forms, its inverse, and where it ends. What OpenCV
// makes of the same numbers stands in calibration_file_test.cpp.
#include "rig/camera/lens_model.h"

#include "base/error.h"
#include "rig/camera/lens.h"
#include "rig/file/rig_reader.h"
#include "support/has.h"
#include "support/random_camera.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aphotic::lens_model_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRounding_px = 1e-10;  // of images a thousand pixels wide
constexpr double kInverse = 1e-13;      // a few roundings of a unit vector

Camera camera_of(int width_px, int height_px, double focal_px) {
    Camera camera = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml").camera;
    camera.width_px = width_px;
    camera.height_px = height_px;
    camera.focal_length_m = focal_px * camera.pixel_pitch_m;
    return camera;
}

TEST(LensModel, WithoutCoefficientsIsAPinhole) {
    const Camera pinhole = camera_of(1360, 1024, 1800.0);
    Camera calibrated = pinhole;
    calibrated.lens = LensModel{.focal_px = {1800.0, 1800.0}, .centre_px = {680.0, 512.0}};
    EXPECT_TRUE(is_pinhole(*calibrated.lens, 1360, 1024));
    for (const Vector2d& at :
         {Vector2d(0.5, 0.5), Vector2d(680.0, 512.0), Vector2d(1359.5, 3.25)}) {
        EXPECT_LT((direction_in_air(calibrated, at.x(), at.y()) -
                   direction_in_air(pinhole, at.x(), at.y()))
                      .norm(),
                  kInverse);
    }
}

// A point one focal length down the image, 45 degrees off the axis: X right, Y down.
TEST(LensModel, HasTheFormulasOfItsHeader) {
    LensModel lens{.focal_px = {1000.0, 900.0}, .centre_px = {600.0, 500.0}, .skew_px = 5.0};
    lens.radial = {0.1, 0.01, 0.001, 0.0001};
    lens.radial_below = {0.2, 0.02, 0.002};
    lens.tangential = {0.003, 0.004};
    // a = 0, b = 1, r = 1: s = 1.1111 / 1.222; a' = p2, b' = s + 3 p1.
    const double s = 1.1111 / 1.222;
    const Vector2d found = image_point(lens, {0.0, 1.0, 1.0});
    EXPECT_NEAR(found.x(), 600.0 + 1000.0 * 0.004 + 5.0 * (s + 0.009), kRounding_px);
    EXPECT_NEAR(found.y(), 500.0 + 900.0 * (s + 0.009), kRounding_px);
    // b = theta = pi/4 of a fisheye.
    LensModel fisheye{.focal_px = {1000.0, 1000.0}, .centre_px = {600.0, 500.0}};
    fisheye.is_fisheye = true;
    fisheye.radial = {0.1, 0.0, 0.0, 0.0};
    const double theta = std::numbers::pi / 4.0;
    EXPECT_NEAR(image_point(fisheye, {0.0, 1.0, 1.0}).y(),
                500.0 + 1000.0 * theta * (1.0 + 0.1 * theta * theta),
                kRounding_px);
}

TEST(LensModel, ItsInverseIsItsInverse) {
    const Camera camera = camera_of(800, 600, 700.0);
    Dice dice(71);
    for (const LensKind kind : kLensKinds) {
        for (int i = 0; i < 20; ++i) {
            const LensModel lens = random_lens_of(kind, dice, camera);
            for (int k = 0; k < 30; ++k) {
                const Vector2d at(dice.between(0.0, 800.0), dice.between(0.0, 600.0));
                const auto direction = direction_at(lens, at);
                ASSERT_TRUE(direction);
                EXPECT_NEAR(direction->norm(), 1.0, kInverse);
                EXPECT_LT((image_point(lens, *direction) - at).norm(), kRounding_px);
            }
        }
    }
}

// s r = r - r^3 / 3 ends where r = 1, at 45 degrees: 2/3 of a focal length from the axis.
TEST(LensModel, EndsWhereTheImageNoLongerGrows) {
    LensModel lens{.focal_px = {300.0, 300.0}, .centre_px = {150.0, 100.0}};
    lens.radial = {-1.0 / 3.0, 0.0, 0.0, 0.0};
    EXPECT_TRUE(direction_at(lens, {150.0 + 199.0, 100.0}));
    EXPECT_FALSE(direction_at(lens, {150.0 + 201.0, 100.0}));
    EXPECT_NO_THROW(require_to_hold(lens, 300, 200));
    EXPECT_TRUE(
        has(refusal_of([&] { require_to_hold(lens, 400, 300); }), "valid to 45.00 degrees"));
}

TEST(LensModel, SignaturesTellEveryNumber) {
    const LensModel lens{.focal_px = {300.0, 300.0}, .centre_px = {200.0, 150.0}};
    for (const auto& change : {+[](LensModel& l) { l.focal_px.y() += 1e-9; },
                               +[](LensModel& l) { l.centre_px.x() += 1e-9; },
                               +[](LensModel& l) { l.skew_px = 1e-9; },
                               +[](LensModel& l) { l.is_fisheye = true; },
                               +[](LensModel& l) { l.radial[3] = 1e-9; },
                               +[](LensModel& l) { l.radial_below[2] = 1e-9; },
                               +[](LensModel& l) { l.tangential[1] = 1e-9; }}) {
        LensModel other = lens;
        change(other);
        EXPECT_NE(lens_model_signature(other), lens_model_signature(lens));
    }
}

}  // namespace
}  // namespace aphotic::lens_model_test
