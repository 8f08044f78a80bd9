// SPDX-License-Identifier: BSD-3-Clause
#include "image/preview.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/any_image.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace aphotic::preview_test {
namespace {

namespace fs = std::filesystem;

constexpr std::array<double, kChannels> kNoLamp{1.0, 1.0, 1.0};

struct Rgb {
    int red, green, blue;
    bool operator==(const Rgb&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Rgb& rgb) {
    return out << rgb.red << ' ' << rgb.green << ' ' << rgb.blue;
}

struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;  // row by row
};

Picture read_png(const fs::path& file) {
    cairo_surface_t* surface = cairo_image_surface_create_from_png(file.c_str());
    Picture picture{.width = cairo_image_surface_get_width(surface),
                    .height = cairo_image_surface_get_height(surface),
                    .pixels = {}};
    const int stride = cairo_image_surface_get_stride(surface);
    const unsigned char* data = cairo_image_surface_get_data(surface);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const unsigned char* bgr =
                data + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4;
            picture.pixels.push_back({bgr[2], bgr[1], bgr[0]});
        }
    }
    cairo_surface_destroy(surface);
    return picture;
}

// One row of pixels per channel: samples.size() / 3 pixels.
CameraImage one_row(std::vector<float> samples) {
    const auto width_px = static_cast<int>(samples.size() / kChannels);
    return {.width_px = width_px, .height_px = 1, .samples = std::move(samples)};
}

Picture shown(const CameraImage& image,
              const std::array<double, kChannels>& lamp_signal,
              const PreviewOptions& options) {
    const TempFolder folder;
    const fs::path file = folder.path() / "preview.png";
    write_preview(image, lamp_signal, options, file);
    return read_png(file);
}

// The 8-bit value of a linear one, from the formula of IEC 61966-2-1 above 0.0031308.
int srgb_byte(double linear) {
    return static_cast<int>(std::lround(255.0 * (1.055 * std::pow(linear, 1.0 / 2.4) - 0.055)));
}

TEST(SrgbEncoded, HasTheValuesOfTheStandard) {
    constexpr double kSixDecimals = 0.5e-6;  // the expected values are given to six decimals
    // The standard's two pieces meet to 1e-8 only, since its constants are rounded.
    constexpr double kAtTheJoint = 1e-7;
    EXPECT_EQ(srgb_encoded(0.0), 0.0);
    EXPECT_NEAR(srgb_encoded(0.001), 0.01292, kSixDecimals);
    EXPECT_NEAR(srgb_encoded(0.0031308), 0.0031308 * 12.92, kAtTheJoint);
    // By hand: the upper piece's slope at the joint is 12.70.
    EXPECT_NEAR(srgb_encoded(0.0031309), 0.0404499 + 12.70 * 1e-7, kAtTheJoint);
    EXPECT_NEAR(srgb_encoded(0.5), 0.735357, kSixDecimals);
    EXPECT_NEAR(srgb_encoded(1.0), 1.0, kSixDecimals);
}

TEST(SrgbEncoded, ClipsOutside) {
    EXPECT_EQ(srgb_encoded(-1.0), 0.0);
    EXPECT_EQ(srgb_encoded(2.0), srgb_encoded(1.0));
}

// The signal of a grey surface is the lamp's own, dimmer.
TEST(Preview, ShowsAGreySurfaceUnderTheLampGrey) {
    const std::array<double, kChannels> lamp{8.0, 2.0, 0.5};
    const CameraImage image = one_row({4.0F, 1.0F, 1.0F, 0.25F, 0.25F, 0.0625F});
    const Picture picture = shown(image, lamp, {});
    for (const Rgb& pixel : picture.pixels) {
        EXPECT_EQ(pixel.red, pixel.green) << pixel;
        EXPECT_EQ(pixel.green, pixel.blue) << pixel;
    }
    EXPECT_GT(picture.pixels[0].red, picture.pixels[1].red);
    EXPECT_GT(picture.pixels[1].red, 0);
}

TEST(Preview, WithoutAWhiteShowsTheSignalsAsTheyAre) {
    const Picture picture =
        shown(one_row({0.5F, 1.0F, 0.25F}), {8.0, 2.0, 0.5}, {.white = PreviewWhite::None});
    // Of three values the second is the quantile: the rank is rounded down.
    EXPECT_EQ(picture.pixels.front(),
              (Rgb{srgb_byte(kBrightLevel), 255, srgb_byte(kBrightLevel / 2.0)}));
}

TEST(Preview, WithTheImagesOwnWhiteHasAGreyMean) {
    // Means 3, 6 and 12; each pixel is the same multiple of them in every channel.
    const Picture picture = shown(
        one_row({2.0F, 4.0F, 4.0F, 8.0F, 8.0F, 16.0F}), kNoLamp, {.white = PreviewWhite::Image});
    for (const Rgb& pixel : picture.pixels) {
        EXPECT_EQ(pixel.red, pixel.green) << pixel;
        EXPECT_EQ(pixel.green, pixel.blue) << pixel;
    }
}

// 1000 pixels, of each channel 0, 1, ... 999: the 0.995 quantile over all samples is near 995.
TEST(Preview, PutsTheBrightQuantileAtItsLevel) {
    std::vector<float> ramp;
    for (int c = 0; c < kChannels; ++c) {
        for (int i = 0; i < 1000; ++i) ramp.push_back(static_cast<float>(i));
    }
    const Picture picture = shown(one_row(ramp), kNoLamp, {});
    // One sample more or less at the quantile is a thousandth of the level: under one byte.
    constexpr int kOneByte = 1;
    const int found = picture.pixels[995].red;
    const int wanted = srgb_byte(0.9);
    EXPECT_NEAR(found, wanted, kOneByte);
    EXPECT_NEAR(picture.pixels[500].red, srgb_byte(0.9 * 500.0 / 995.0), kOneByte);
    EXPECT_EQ(picture.pixels[0].red, 0);
}

// The same ramp, over more samples than any subset of them that a program would look at.
TEST(Preview, FindsTheQuantileOfALargeImage) {
    constexpr int kSide = 700;
    CameraImage image{.width_px = kSide, .height_px = kSide, .samples = {}};
    for (int c = 0; c < kChannels; ++c) {
        for (int i = 0; i < kSide * kSide; ++i) image.samples.push_back(static_cast<float>(i));
    }
    const Picture picture = shown(image, kNoLamp, {});
    constexpr int kOneByte = 1;
    const auto at_quantile = static_cast<std::size_t>(0.995 * kSide * kSide);
    EXPECT_NEAR(picture.pixels[at_quantile].red, srgb_byte(0.9), kOneByte);
}

// By libpng's word, behind a checksum that it verifies.
TEST(Preview, SaysThatItIsSrgb) {
    const TempFolder folder;
    const CameraImage image{.width_px = 2, .height_px = 1, .samples = {1, 1, 1, 1, 1, 1}};
    write_preview(image, {1.0, 1.0, 1.0}, {}, folder.path() / "preview.png");
    EXPECT_EQ(header_of_image(folder.path() / "preview.png")["oiio:ColorSpace"], "sRGB");
    const std::string png = read_text_file(folder.path() / "preview.png");
    EXPECT_NE(png.find("sRGB"), std::string::npos);
}

TEST(Preview, IsBrighterByPowersOfTwo) {
    std::vector<float> samples(300, 1.0F);
    samples[0] = 0.25F;
    const Picture plain = shown(one_row(samples), kNoLamp, {});
    const Picture brighter = shown(one_row(samples), kNoLamp, {.stops = 1.0});
    EXPECT_EQ(plain.pixels[0].red, srgb_byte(0.9 / 4.0));
    EXPECT_EQ(brighter.pixels[0].red, srgb_byte(0.9 / 2.0));
    EXPECT_EQ(brighter.pixels[1].red, 255) << "1.8 is clipped";
}

TEST(Preview, LeavesABlackImageBlack) {
    for (const PreviewWhite white : {PreviewWhite::Lamp, PreviewWhite::Image, PreviewWhite::None}) {
        const Picture picture =
            shown(one_row(std::vector<float>(30, 0.0F)), {0.0, 0.0, 0.0}, {.white = white});
        ASSERT_EQ(picture.pixels.size(), 10U);
        for (const Rgb& pixel : picture.pixels) EXPECT_EQ(pixel, (Rgb{0, 0, 0}));
    }
}

// Fitted weights may be negative, so signals may be.
TEST(Preview, ShowsNegativeSignalsBlack) {
    const Picture picture = shown(one_row({-1.0F, 1.0F, -1.0F, 1.0F, -1.0F, 1.0F}), kNoLamp, {});
    EXPECT_EQ(picture.pixels[0], (Rgb{0, 0, 0}));
}

TEST(Preview, KeepsRowsAndColumns) {
    // Two rows of three pixels; only the second row's last pixel is lit, and only in blue.
    CameraImage image{.width_px = 3, .height_px = 2, .samples = std::vector<float>(18, 0.0F)};
    image.samples[17] = 1.0F;
    image.samples[0] = 1.0F;  // and the first pixel in red, so that the quantile is not 0
    image.samples[1] = 1.0F;
    const Picture picture = shown(image, kNoLamp, {.white = PreviewWhite::None});
    EXPECT_EQ(picture.width, 3);
    EXPECT_EQ(picture.height, 2);
    EXPECT_EQ(picture.pixels[5], (Rgb{0, 0, srgb_byte(kBrightLevel)}));
    EXPECT_EQ(picture.pixels[0], (Rgb{srgb_byte(kBrightLevel), 0, 0}));
    EXPECT_EQ(picture.pixels[4], (Rgb{0, 0, 0}));
}

// Under one scale, a pixel's colour depends on its own signal alone.
TEST(PreviewPng, UnderOneScaleShowsEqualSignalsEqual) {
    const std::array<double, kChannels> scale{0.5, 1.0, 2.0};
    const TempFolder folder;
    const auto first_pixel = [&](const CameraImage& image) {
        write_file(folder.path() / "a.png", preview_png(image, scale));
        return read_png(folder.path() / "a.png").pixels.front();
    };
    const Rgb wanted{srgb_byte(0.2), srgb_byte(0.4), srgb_byte(0.8)};
    EXPECT_EQ(first_pixel(one_row({0.4F, 0.4F, 0.4F})), wanted);
    EXPECT_EQ(first_pixel(one_row({0.4F, 9.0F, 0.4F, 9.0F, 0.4F, 9.0F})), wanted);
}

TEST(PreviewPng, OfSamplesThatAreNotFiniteKeepsTheOthers) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const CameraImage image = one_row({kNaN, 1.0F, kNaN, 1.0F, kNaN, 1.0F});
    const Picture picture = shown(image, kNoLamp, {});
    EXPECT_EQ(picture.pixels[0], (Rgb{0, 0, 0}));
    const int level = srgb_byte(kBrightLevel);
    EXPECT_EQ(picture.pixels[1], (Rgb{level, level, level}));
}

TEST(Preview, ThatCannotBeWrittenIsARunErrorThatNamesIt) {
    const TempFolder folder;
    const fs::path file = folder.path() / "missing" / "preview.png";
    const std::string said = run_error_of([&] {
        write_preview(one_row({1.0F, 1.0F, 1.0F}), kNoLamp, {}, file);
    });
    EXPECT_TRUE(said.starts_with(file.string() + ": cannot be written: ")) << said;
}

}  // namespace
}  // namespace aphotic::preview_test
