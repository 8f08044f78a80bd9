// SPDX-License-Identifier: BSD-3-Clause
#include "validation/error_view.h"

#include "report/page.h"
#include "support/png.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace aphotic::error_view_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kMostBlue = -(kColourSteps - 1) / 2;
constexpr int kMostRed = (kColourSteps - 1) / 2;

// a and b: all finite unless given.
DecodedPng map_of(const std::vector<float>& errors, int width_px, double scale) {
    const std::vector<float> finite(errors.size(), 1.0F);
    return decode_png(
        error_map({.errors = errors, .image = finite, .reference = finite, .width_px = width_px},
                  scale)
            .png);
}

TEST(BlockSide, KeepsPicturesUnderTheLimit) {
    EXPECT_EQ(block_side(68, 51), 1);
    EXPECT_EQ(block_side(1000, 1000), 1);
    EXPECT_EQ(block_side(1001, 10), 2);
    EXPECT_EQ(block_side(1360, 1024), 2);
    EXPECT_EQ(block_side(10, 4100), 5);
}

TEST(BlockMeans, AreTheMeansOfTheirPixels) {
    // Three columns and two rows: the second block is one column wide.
    CameraImage image{.width_px = 3, .height_px = 2, .samples = {}};
    for (int c = 0; c < kChannels; ++c) {
        for (const float sample : {1.0F, 2.0F, 5.0F, 3.0F, 6.0F, 7.0F})
            image.samples.push_back(sample + 10.0F * static_cast<float>(c));
    }
    const CameraImage means = block_means(image, 2);
    EXPECT_EQ(means.width_px, 2);
    EXPECT_EQ(means.height_px, 1);
    EXPECT_EQ(means.samples, (std::vector<float>{3.0F, 6.0F, 13.0F, 16.0F, 23.0F, 26.0F}));
}

TEST(ErrorColour, IsWhiteAtZeroAndDarkerEitherWay) {
    const auto light = [](int step) {
        const std::uint32_t colour = error_colour(step);
        return (colour >> 16U & 0xFFU) + (colour >> 8U & 0xFFU) + (colour & 0xFFU);
    };
    for (int step = 0; step < kMostRed; ++step) {
        EXPECT_GT(light(step), light(step + 1)) << step;
        EXPECT_GT(light(-step), light(-step - 1)) << -step;
    }
    EXPECT_GT(light(0), 3U * 0xF0U);
    EXPECT_GT(error_colour(kMostRed) >> 16U, error_colour(kMostRed) & 0xFFU) << "red above";
    EXPECT_LT(error_colour(kMostBlue) >> 16U, error_colour(kMostBlue) & 0xFFU) << "blue below";
}

TEST(ErrorMap, ShowsSignSizeAndEdges) {
    const DecodedPng map = map_of({0.0F, 1e-3F, -1e-3F, 5e-4F, kNaN, -5.0F}, 3, 1e-3);
    EXPECT_EQ(map.width, 3);
    EXPECT_EQ(map.height, 2);
    EXPECT_EQ(map.pixels,
              (std::vector<std::uint32_t>{error_colour(0),
                                          error_colour(kMostRed),
                                          error_colour(kMostBlue),
                                          error_colour(kMostRed / 2),
                                          kEdgeColour,
                                          error_colour(kMostBlue)}));
}

TEST(ErrorMap, ShowsSamplesThatAreNotFinite) {
    const std::vector<float> errors{kNaN, kNaN, 0.0F};
    const std::vector<float> a{kNaN, 1.0F, 1.0F};
    const std::vector<float> b{1.0F, 1.0F, 1.0F};
    const std::vector<std::uint32_t> wanted{kNotFiniteColour, kEdgeColour, error_colour(0)};
    EXPECT_EQ(decode_png(
                  error_map({.errors = errors, .image = a, .reference = b, .width_px = 3}, 1.0).png)
                  .pixels,
              wanted);
    EXPECT_EQ(decode_png(
                  error_map({.errors = errors, .image = b, .reference = a, .width_px = 3}, 1.0).png)
                  .pixels,
              wanted)
        << "the reference's";
}

// The one large error of a block must not be averaged away, nor hidden by an edge beside it.
TEST(ErrorMap, OfALargeImageKeepsTheLargestOfEachBlock) {
    constexpr int kWidth = 1200;
    std::vector<float> errors(2UL * kWidth, 1e-5F);
    errors[0] = kNaN;
    errors[kWidth + 1] = -1e-3F;
    errors[2] = errors[3] = errors[kWidth + 2] = errors[kWidth + 3] = kNaN;
    const DecodedPng map = map_of(errors, kWidth, 1e-3);
    EXPECT_EQ(map.width, kWidth / 2);
    EXPECT_EQ(map.height, 1);
    EXPECT_EQ(map.pixels[0], error_colour(kMostBlue));
    EXPECT_EQ(map.pixels[1], kEdgeColour);
    EXPECT_EQ(map.pixels[2], error_colour(0));
}

// RFC 4648, section 10.
TEST(DataUri, IsBase64) {
    EXPECT_EQ(data_uri(""), "data:image/png;base64,");
    EXPECT_EQ(data_uri("f"), "data:image/png;base64,Zg==");
    EXPECT_EQ(data_uri("foob"), "data:image/png;base64,Zm9vYg==");
    EXPECT_EQ(data_uri("foobar"), "data:image/png;base64,Zm9vYmFy");
}

}  // namespace
}  // namespace aphotic::error_view_test
