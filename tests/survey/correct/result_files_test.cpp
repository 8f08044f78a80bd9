// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/result_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::result_files_test {
namespace {

// Of lines in place of the power, in 65536 steps: least good across the bend, where the slope falls
// by 0.2; 0.04 of a 16-bit step.
constexpr double kCurve = 6e-7;

// The standard's own numbers at its bend, and powers of bc: e((1/2.4)*l(0.5))*1.055-0.055 =
// 0.735357.
TEST(SrgbPlanes, FollowTheStandardsCurveAndClip) {
    const RawImage image{.width_px = 6,
                         .height_px = 1,
                         .mosaic = Mosaic::None,
                         .samples = {0.0F,
                                     0.001F,
                                     0.0031308F,
                                     0.18F,
                                     0.5F,
                                     1.0F,  //
                                     -1.0F,
                                     2.0F,
                                     0.0F,
                                     0.0F,
                                     0.0F,
                                     0.0F,  //
                                     1e-6F,
                                     1e30F,
                                     -1e30F,
                                     0.0F,
                                     0.0F,
                                     0.999999F}};
    const std::vector<float> shown = srgb_planes(image, Eigen::Matrix3d::Identity());
    EXPECT_EQ(shown[0], 0.0F);
    EXPECT_NEAR(shown[1], 0.01292, kCurve);
    EXPECT_NEAR(shown[2], 0.0404499, kCurve);
    EXPECT_NEAR(shown[3], 0.4613561, kCurve);
    EXPECT_NEAR(shown[4], 0.7353570, kCurve);
    EXPECT_EQ(shown[5], 1.0F);
    EXPECT_EQ(shown[6], 0.0F);
    EXPECT_EQ(shown[7], 1.0F);
    EXPECT_NEAR(shown[12], 1.292e-5, kCurve);
    EXPECT_EQ(shown[13], 1.0F);
    EXPECT_EQ(shown[14], 0.0F);
}

TEST(SrgbPlanes, MixTheChannelsOfAPixel) {
    Eigen::Matrix3d rotated;
    rotated << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    const RawImage image{.width_px = 2,
                         .height_px = 1,
                         .mosaic = Mosaic::None,
                         .samples = {1.0F, 0.0F, 0.5F, 0.0F, 0.0F, 1.0F}};
    const std::vector<float> shown = srgb_planes(image, rotated);
    const std::vector<float> wanted{0.7353570F, 0.0F, 0.0F, 1.0F, 1.0F, 0.0F};
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(shown[i], wanted[i], kCurve) << i;
}

TEST(SrgbEncoding, PutsTheMiddleAtAFifth) {
    const double exposure = srgb_encoding(std::nullopt, PerChannel{0.4, 0.4, 0.4}, 0.0).exposure;
    EXPECT_DOUBLE_EQ(exposure, 0.5);
    EXPECT_DOUBLE_EQ(srgb_encoding(std::nullopt, PerChannel{0.4, 0.4, 0.4}, 1.0).exposure, 1.0);
    // Green alone: 0.7152 of the luminance.
    EXPECT_DOUBLE_EQ(srgb_encoding(std::nullopt, PerChannel{0.0, 1.0, 0.0}, 0.0).exposure,
                     0.2 / 0.7152);
}

TEST(SrgbEncoding, LeavesNumbersAsTheyAreWhoseMiddleNobodyKnows) {
    EXPECT_EQ(srgb_encoding(std::nullopt, std::nullopt, 0.0).exposure, 1.0);
    EXPECT_EQ(srgb_encoding(std::nullopt, std::nullopt, -2.0).exposure, 0.25);
    EXPECT_EQ(srgb_encoding(std::nullopt, std::nullopt, 0.0).matrix(), Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace aphotic::result_files_test
