// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/vignetting.h"

#include "base/error.h"
#include "rig/file/rig_reader.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace aphotic::vignetting_test {
namespace {

constexpr double kRounding = 1e-14;

// The middle of the lower rim is 45 degrees off the axis.
Camera camera() {
    Camera made = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml").camera;
    made.width_px = 400;
    made.height_px = 300;
    made.pixel_pitch_m = 1e-5;
    made.focal_length_m = 150e-5;
    return made;
}

std::string fault_in(std::string_view csv) {
    return refusal_of([&] { static_cast<void>(parse_vignetting_csv("v.csv", csv)); });
}

TEST(Vignetting, IsTheFourthPowerOfTheCosine) {
    Camera lens = camera();
    EXPECT_EQ(vignetting_at(lens, 200.0, 300.0), 1.0);
    lens.vignetting = NaturalVignetting{};
    EXPECT_NEAR(vignetting_at(lens, 200.0, 150.0), 1.0, kRounding);
    EXPECT_NEAR(vignetting_at(lens, 200.0, 300.0), 0.25, kRounding);
}

// cos 45 degrees = 2^(-1/2).
TEST(Vignetting, IsAnyPowerOfTheCosine) {
    Camera lens = camera();
    for (const auto& [exponent, wanted] :
         {std::pair{0.0, 1.0}, {1.0, std::sqrt(0.5)}, {2.0, 0.5}, {4.0, 0.25}, {50.0, 0x1p-25}}) {
        lens.vignetting = NaturalVignetting{exponent};
        EXPECT_NEAR(vignetting_at(lens, 200.0, 150.0), 1.0, kRounding) << exponent;
        EXPECT_NEAR(vignetting_at(lens, 200.0, 300.0), wanted, kRounding) << exponent;
        EXPECT_NO_THROW(require_bright(lens)) << exponent;
    }
}

// p is 1 at the corner, 3/5 at the middle of the lower rim of a 4:3 image.
TEST(Vignetting, IsAPolynomialInTheDistanceFromThePrincipalPoint) {
    Camera lens = camera();
    lens.vignetting = RadialVignetting{{-0.3, 0.05, -0.01}};
    EXPECT_NEAR(vignetting_at(lens, 0.0, 0.0), 0.74, kRounding);
    const double q = 0.36;
    EXPECT_NEAR(vignetting_at(lens, 200.0, 300.0),
                1.0 - 0.3 * q + 0.05 * q * q - 0.01 * q * q * q,
                kRounding);
    lens.lens = LensModel{.focal_px = {150.0, 150.0}, .centre_px = {200.0, 300.0}};
    EXPECT_NEAR(vignetting_at(lens, 200.0, 300.0), 1.0, kRounding);
}

TEST(Vignetting, IsALineBetweenTheRowsOfATable) {
    Camera lens = camera();
    lens.vignetting = parse_vignetting_csv("v.csv", "angle_deg,factor\n0,1\n30,0.9\n60,0.5\n");
    EXPECT_NEAR(vignetting_at(lens, 200.0, 300.0), 0.7, kRounding);
    EXPECT_NO_THROW(require_bright(lens));
    lens.vignetting = parse_vignetting_csv("v.csv", "angle_deg,factor\n0,1\n50,0.9\n");
    EXPECT_THROW(require_bright(lens), InputError);  // the corner is at 59
}

TEST(Vignetting, TablesThatCannotBeAreRefused) {
    EXPECT_EQ(fault_in("angle,factor\n0,1\n1,1\n"),
              "v.csv:1: found the columns angle,factor; allowed: angle_deg,factor");
    EXPECT_EQ(fault_in("angle_deg,factor\n1,1\n2,1\n"),
              "v.csv:2: angle_deg: found 1; allowed: from 0, increasing");
    EXPECT_EQ(fault_in("angle_deg,factor\n0,1\n2,1\n2,1\n"),
              "v.csv:4: angle_deg: found 2; allowed: from 0, increasing");
    EXPECT_EQ(fault_in("angle_deg,factor\n0,1\n2,0\n"),
              "v.csv:3: factor: found 0; allowed: above 0");
    EXPECT_EQ(fault_in("angle_deg,factor\n0,1\n"), "v.csv:1: found 1 rows; allowed: 2 or more");
}

TEST(Vignetting, ThatLeavesNoLightIsRefused) {
    Camera lens = camera();
    lens.vignetting = RadialVignetting{{-1.5, 0.0, 0.0}};
    EXPECT_THROW(require_bright(lens), InputError);
}

}  // namespace
}  // namespace aphotic::vignetting_test
