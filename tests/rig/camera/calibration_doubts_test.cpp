// SPDX-License-Identifier: BSD-3-Clause
//
// Calibrations that hold, but cannot be meant. Fields of view by hand: 4000 pixels at 35 pixels of
// focal length are 2 atan(2000 / 35) = 177.99 degrees.
#include "rig/camera/calibration_doubts.h"

#include <gtest/gtest.h>

namespace aphotic {
namespace {

constexpr int kWidth_px = 4000;
constexpr int kHeight_px = 3000;

LensModel lens(double focal_px, double x_px, double y_px) {
    return {.focal_px = {focal_px, focal_px}, .centre_px = {x_px, y_px}};
}

std::vector<std::string> doubts(const LensModel& lens) {
    return calibration_doubts(lens, kWidth_px, kHeight_px);
}

TEST(CalibrationDoubts, ThereAreNoneOfUsualLenses) {
    EXPECT_TRUE(doubts(lens(3000.0, 2000.0, 1500.0)).empty());
    EXPECT_TRUE(doubts(lens(3000.0, 2300.0, 1250.0)).empty());
    LensModel fisheye = lens(1273.0, 2000.0, 1500.0);  // 180 degrees across
    fisheye.is_fisheye = true;
    EXPECT_TRUE(doubts(fisheye).empty());
}

TEST(CalibrationDoubts, APrincipalPointFarFromTheMiddleIsSaid) {
    const std::string found = "principal point: found ";
    const std::string usual = " in an image of 4000 x 3000; usual: near the middle, 2000, 1500; ";
    const std::string unset =
        "is it relative to the middle, a fraction of the image's size, or missing?";
    EXPECT_EQ(doubts(lens(3000.0, 0.0, 0.0)), std::vector{found + "0, 0" + usual + unset});
    EXPECT_EQ(doubts(lens(3000.0, 0.5, 0.5)), std::vector{found + "0.5, 0.5" + usual + unset});
    const std::string scaled = "are the calibration and the images of the same size?";
    EXPECT_EQ(doubts(lens(3000.0, 1000.0, 750.0)),
              std::vector{found + "1000, 750" + usual + scaled});
    EXPECT_EQ(doubts(lens(3000.0, 2000.0, -40.0)).size(), 1U);
}

TEST(CalibrationDoubts, FocalLengthsThatNoCameraHasAreSaid) {
    EXPECT_EQ(doubts(lens(35.0, 2000.0, 1500.0)),
              std::vector<std::string>{
                  "focal length: found 35 pixels, a field of view of 178 degrees across 4000 "
                  "pixels; usual: 2 to 150 degrees; is it in millimetres?"});
    EXPECT_EQ(doubts(lens(3e6, 2000.0, 1500.0)).size(), 1U);
    LensModel askew = lens(3000.0, 2000.0, 1500.0);
    askew.focal_px.y() = 300.0;
    EXPECT_EQ(doubts(askew).size(), 1U);
}

}  // namespace
}  // namespace aphotic
