// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/raw_camera.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace aphotic::survey::raw_camera_test {
namespace {

CameraImage uniform(int side_px, std::array<float, kChannels> signal) {
    CameraImage image{.width_px = side_px, .height_px = side_px, .samples = {}};
    const auto pixels = static_cast<std::size_t>(side_px * side_px);
    for (const float s : signal) image.samples.insert(image.samples.end(), pixels, s);
    return image;
}

TEST(RawCamera, PutsEachChannelUnderItsFilter) {
    // Of black 64 and white 4095: 64 + 4031 x 0.25, x 0.5 and x 0.75.
    const std::vector<std::uint16_t> expected{1072, 2080, 2080, 3087};
    EXPECT_EQ(raw_mosaic(uniform(2, {0.25F, 0.5F, 0.75F}), {.full_signal = 1.0}, {}), expected);
}

TEST(RawCamera, IsBlackWithoutLightAndWhiteWithTooMuch) {
    EXPECT_EQ(raw_mosaic(uniform(1, {0.0F, 0.0F, 0.0F}), {.full_signal = 2.0}, {}).front(), 64);
    EXPECT_EQ(raw_mosaic(uniform(1, {2.0F, 0.0F, 0.0F}), {.full_signal = 2.0}, {}).front(), 4095);
    EXPECT_EQ(raw_mosaic(uniform(1, {9.0F, 0.0F, 0.0F}), {.full_signal = 2.0}, {}).front(), 4095);
}

TEST(RawCamera, HasTheNoiseOfItsElectrons) {
    constexpr int kSide_px = 200;
    const CameraImage image = uniform(kSide_px, {0.5F, 0.5F, 0.5F});
    const RawCamera camera{.full_signal = 1.0, .full_well_e = 10000.0, .read_noise_e = 20.0};
    const std::vector<std::uint16_t> mosaic = raw_mosaic(image, camera, 3);
    double sum = 0.0;
    double squares = 0.0;
    for (const double number : mosaic) {
        sum += number;
        squares += number * number;
    }
    const auto n = static_cast<double>(mosaic.size());
    const double mean = sum / n;
    // 5000 electrons of shots, 400 of read noise squared, and the rounding.
    const double number_per_e = 4031.0 / 10000.0;
    const double variance = number_per_e * number_per_e * 5400.0 + 1.0 / 12.0;
    // Four standard deviations of each estimate.
    EXPECT_NEAR(mean, 64.0 + 4031.0 / 2.0, 4.0 * std::sqrt(variance / n));
    EXPECT_NEAR(squares / n - mean * mean, variance, 4.0 * variance * std::sqrt(2.0 / n));
    EXPECT_EQ(raw_mosaic(image, camera, 3), mosaic) << "the same seed is the same noise";
    EXPECT_NE(raw_mosaic(image, camera, 4), mosaic);
}

}  // namespace
}  // namespace aphotic::survey::raw_camera_test
