// SPDX-License-Identifier: BSD-3-Clause
//
// The camera of simulated surveys, and what the estimators of EMVA 1288 (release 4.0 Linear,
// chapters 4 and 6) find of it.
#include "survey/simulate/raw_camera.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace aphotic::raw_camera_test {
namespace {

CameraImage even(int side_px, std::array<float, kChannels> signal) {
    CameraImage image{.width_px = side_px, .height_px = side_px, .samples = {}};
    const auto pixels = static_cast<std::size_t>(side_px * side_px);
    for (const float s : signal) image.samples.insert(image.samples.end(), pixels, s);
    return image;
}

RawCamera camera_of_signal(double electrons_per_signal) {
    RawCamera camera;
    camera.electrons_per_signal = electrons_per_signal;
    return camera;
}

TEST(RawCamera, PutsEachChannelUnderItsFilter) {
    // Of black 64 and white 4095, at 15000 electrons: 64 + 4031 x 0.25, x 0.5 and x 0.75.
    const CameraImage image = even(2, {0.25F, 0.5F, 0.75F});
    RawCamera camera = camera_of_signal(15000.0);
    EXPECT_EQ(raw_samples(image, camera, {}), (std::vector<std::uint16_t>{1072, 2080, 2080, 3087}));
    camera.mosaic = Mosaic::Gbrg;
    EXPECT_EQ(raw_samples(image, camera, {}), (std::vector<std::uint16_t>{2080, 3087, 1072, 2080}));
    camera.mosaic = Mosaic::Mono;
    EXPECT_EQ(raw_samples(image, camera, {}), std::vector<std::uint16_t>(4, 1072));
}

TEST(RawCamera, IsBlackWithoutLightAndWhiteWithTooMuch) {
    const RawCamera camera = camera_of_signal(7500.0);
    EXPECT_EQ(raw_samples(even(1, {0.0F, 0.0F, 0.0F}), camera, {}).front(), 64);
    EXPECT_EQ(raw_samples(even(1, {2.0F, 0.0F, 0.0F}), camera, {}).front(), 4095);
    EXPECT_EQ(raw_samples(even(1, {9.0F, 0.0F, 0.0F}), camera, {}).front(), 4095);
}

TEST(RawCamera, IsFullAtItsWellBeforeWhite) {
    RawCamera camera = camera_of_signal(1.0);
    camera.gain_dn_per_e = 0.1;
    camera.saturation_e = 20000.0;
    EXPECT_EQ(raw_samples(even(1, {90000.0F, 0.0F, 0.0F}), camera, {}).front(), 64 + 2000);
}

TEST(RawCamera, HasNoiseOfSeedAndImageAlone) {
    const RawCamera camera = camera_of_signal(1000.0);
    const CameraImage image = even(8, {1.0F, 1.0F, 1.0F});
    const auto noise = [&](std::uint64_t seed, int number) {
        return raw_samples(image, camera, NoiseOf{.seed = seed, .image = number});
    };
    EXPECT_EQ(noise(3, 1), noise(3, 1));
    EXPECT_NE(noise(3, 1), noise(3, 2));
    EXPECT_NE(noise(3, 1), noise(4, 1));
}

TEST(RawCamera, IsWhatTheRigTells) {
    const RawCamera none = raw_camera_of({});
    EXPECT_EQ(none.mosaic, Mosaic::Rggb);
    EXPECT_DOUBLE_EQ(none.gain_dn_per_e, 4031.0 / 15000.0);
    const RawCamera by_well = raw_camera_of({.bayer = "mono",
                                             .black_level_dn = 0.0,
                                             .white_level_dn = 1000.0,
                                             .read_noise_e = 3.0,
                                             .saturation_e = 5000.0},
                                            true);
    EXPECT_EQ(by_well.mosaic, Mosaic::Mono);
    EXPECT_DOUBLE_EQ(by_well.gain_dn_per_e, 0.2) << "white is where the well is full";
    EXPECT_EQ(by_well.read_noise_e, 3.0);
    const RawCamera by_gain =
        raw_camera_of({.black_level_dn = 95.0, .white_level_dn = 4095.0, .gain_dn_per_e = 0.5});
    EXPECT_DOUBLE_EQ(by_gain.saturation_e, 8000.0) << "the well is full where white is";
    const RawCamera by_both = raw_camera_of({.gain_dn_per_e = 0.5, .saturation_e = 5000.0});
    EXPECT_EQ(by_both.gain_dn_per_e, 0.5);
    EXPECT_EQ(by_both.saturation_e, 5000.0);
}

TEST(RawCamera, TakesLevelsOf16BitsAndAPatternOfItsChannels) {
    const auto said = [](const Readout& readout, bool is_mono = false) -> std::string {
        return refusal_of([&] { return raw_camera_of(readout, is_mono); });
    };
    EXPECT_EQ(said({.white_level_dn = 70000.0}),
              "white_level_dn: found 70000; allowed: over the black level, 64, to 65535");
    EXPECT_EQ(said({.black_level_dn = 5000.0}),
              "white_level_dn: found 4095; allowed: over the black level, 5000, to 65535");
    EXPECT_EQ(said({.bayer = "mono"}),
              "bayer: found mono; allowed: a colour pattern, since the rig's response has three "
              "channels");
    EXPECT_EQ(said({.bayer = "RGGB"}, true),
              "bayer: found RGGB; allowed: mono, since the rig's response has one channel");
}

// --- EMVA 1288 --------------------------------------------------------------------------------

constexpr int kSide_px = 256;
constexpr double kPixels = kSide_px * kSide_px;

// A camera of other numbers than by default, which saturates by its well.
RawCamera tested() {
    return {.mosaic = Mosaic::Mono,
            .black_dn = 100.0,
            .white_dn = 65535.0,
            .gain_dn_per_e = 0.8,
            .read_noise_e = 6.0,
            .saturation_e = 12000.0};
}

struct Point {
    double mean;
    double variance;  // over time
};

// Of two images of the same light, by their mean and difference (equations 19 and 20): what
// differs from pixel to pixel and stays falls out.
Point point_of(float electrons) {
    const CameraImage light = even(kSide_px, {electrons, electrons, electrons});
    const int number = 2 * static_cast<int>(electrons) + 1;
    const auto a = raw_samples(light, tested(), NoiseOf{.seed = 5, .image = number});
    const auto b = raw_samples(light, tested(), NoiseOf{.seed = 5, .image = number + 1});
    double sum_a = 0.0;
    double sum_b = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum_a += a[i];
        sum_b += b[i];
        squares += std::pow(a[i] - b[i], 2);
    }
    const double mean_difference = (sum_a - sum_b) / kPixels;
    return {.mean = 0.5 * (sum_a + sum_b) / kPixels,
            .variance = 0.5 * (squares / kPixels - mean_difference * mean_difference)};
}

// Relative standard deviation of such a variance.
const double kOfVariance = std::sqrt(2.0 / kPixels);

// Section 6.6: the photon transfer curve up to 70 % of saturation has the slope K.
TEST(RawCameraByEmva1288, HasItsGainAsTheSlopeOfPhotonTransfer) {
    const Point dark = point_of(0.0F);
    double xy = 0.0;
    double xx = 0.0;
    double error = 0.0;  // squared, of xy
    for (float electrons = 0.0F; electrons <= 8400.0F; electrons += 600.0F) {
        const Point point = point_of(electrons);
        const double x = point.mean - dark.mean;
        xy += x * (point.variance - dark.variance);
        xx += x * x;
        error += std::pow(x * point.variance * kOfVariance, 2);
    }
    EXPECT_NEAR(xy / xx, 0.8, 4.0 * std::sqrt(error) / xx);
}

// Section 6.5, with the variance of rounding, 1/12, taken off as in 4.1.
TEST(RawCameraByEmva1288, HasItsReadNoiseInTheDark) {
    const Point dark = point_of(0.0F);
    EXPECT_NEAR(dark.mean, 100.0, 4.0 * 0.8 * 6.0 / std::sqrt(2.0 * kPixels));
    const double read_noise_e = std::sqrt(dark.variance - 1.0 / 12.0) / 0.8;
    EXPECT_NEAR(read_noise_e / 6.0, 1.0, 4.0 * 0.5 * kOfVariance);
}

// Section 6.6.1: saturation is where the variance is largest. With shots of a spread of 110
// electrons the peak lies a few of these below the well.
TEST(RawCameraByEmva1288, SaturatesWherePhotonTransferPeaks) {
    constexpr float kStep_e = 50.0F;
    const double spread_e = std::sqrt(12000.0);
    Point most{.mean = 0.0, .variance = 0.0};
    double at_e = 0.0;
    for (float electrons = 11000.0F; electrons <= 13000.0F; electrons += kStep_e) {
        const Point point = point_of(electrons);
        if (point.variance <= most.variance) continue;
        most = point;
        at_e = electrons;
    }
    EXPECT_LT(at_e, 12000.0);
    EXPECT_GT(at_e, 12000.0 - 4.0 * spread_e);
    EXPECT_NEAR((most.mean - 100.0) / 0.8 / 12000.0, 1.0, 4.0 * spread_e / 12000.0);
    EXPECT_LT(point_of(14000.0F).variance, 2.0 * (0.64 * 36.0 + 1.0 / 12.0))
        << "of read noise alone";
}

}  // namespace
}  // namespace aphotic::raw_camera_test
