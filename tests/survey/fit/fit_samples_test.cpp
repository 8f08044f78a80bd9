// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_samples.h"

#include "base/degrees.h"
#include "base/error.h"
#include "image/exr.h"
#include "support/absurd_images.h"
#include "support/fit_rig.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::fit_samples_test {
namespace {

constexpr float kRounding = 1e-5F;
constexpr int kWidth_px = 24;
constexpr int kHeight_px = 16;
constexpr int kAcross = 6;

// A slope to the right and down; in a mosaic of which every site sees it.
float slope(double column, double row) {
    return static_cast<float>(100.0 + 3.0 * column + 2.0 * row);
}

class FitSamplesOfAnImage : public testing::Test {
  protected:
    // One plane of the slope; `bright` samples at the top left are at the white level.
    [[nodiscard]] FitSamples samples(int bright) const {
        std::vector<float> plane;
        for (int row = 0; row < kHeight_px; ++row) {
            for (int column = 0; column < kWidth_px; ++column)
                plane.push_back(slope(column + 0.5, row + 0.5));
        }
        std::fill_n(plane.begin(), bright, 1000.0F);
        ExrWriter exr(folder_.path() / "a.exr", kWidth_px, kHeight_px, {"Y"}, {});
        exr.write_rows(kHeight_px, plane);
        exr.finish();
        return samples_of({"a.exr"});
    }

    [[nodiscard]] FitSamples samples_of(const std::vector<std::string>& names) const {
        Survey survey;
        survey.camera.mosaic = Mosaic::Rggb;
        survey.camera.black_level = 64.0F;
        survey.camera.white_level = 1000.0F;
        std::vector<std::string> files;
        std::vector<ImagePose> poses;
        for (const std::string& name : names) {
            files.push_back((folder_.path() / name).string());
            poses.push_back({.image = without_extension(name).string(), .sled = {2.0, 0.1, 0.0}});
        }
        survey.files = image_files(files, folder_.path() / "out");
        survey.navigation = Navigation("track", poses);
        FitRigNumbers numbers;
        numbers.width_px = kWidth_px;
        numbers.height_px = kHeight_px;
        return samples_of_images(survey, fit_rig(numbers).rig(), kAcross, 1, {});
    }

    TempFolder folder_;
};

// Red's sites stand half a pixel before a block's middle, blue's half a pixel behind.
TEST_F(FitSamplesOfAnImage, ABlockOfAMosaicHasTheSlopesMiddle) {
    const FitSamples found = samples(0);
    ASSERT_EQ(found.places.block_px, 4);
    ASSERT_EQ(found.places.size(), 24U);
    for (std::size_t i = 0; i < found.places.size(); ++i) {
        const double column = found.places.column(i);
        const double row = found.places.row(i);
        // At the image's edge a mosaic is mirrored, which bends a slope.
        if (column < 4 || row < 4 || column > kWidth_px - 4 || row > kHeight_px - 4) continue;
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_NEAR(found.images[0].signal[kChannels * i + c],
                        slope(column, row) - 64.0F,
                        kRounding * slope(column, row))
                << column << ' ' << row << ' ' << c;
        }
    }
}

// Headers that ask for gigabytes cost themselves alone.
TEST_F(FitSamplesOfAnImage, ImagesOfAbsurdSizeAreSkippedByTheirHeaders) {
    static_cast<void>(samples(0));
    std::vector<std::string> names{"a.exr"};
    for (const auto& [name, bytes] : absurd_images(kWidth_px, kHeight_px)) {
        write_file(folder_.path() / name, bytes);
        names.push_back(name);
    }
    const FitSamples found = samples_of(names);
    EXPECT_EQ(found.images.size(), 1U);
    ASSERT_EQ(found.skipped.size(), names.size() - 1);
    for (const Skipped& one : found.skipped) {
        for (const char* words : {"alloc", "memory", "vector"})
            EXPECT_FALSE(has(one.why, words)) << one.image << ": ";
        if (!one.image.ends_with("tiff-large.tif")) continue;
        EXPECT_EQ(one.why,
                  fmt::format("found 16000 x 16000 pixels; allowed: {} x {}, like the rig's camera",
                              kWidth_px,
                              kHeight_px));
    }
}

// One sample of a block's four red ones, or eight green ones, is over a hundredth.
TEST_F(FitSamplesOfAnImage, ASaturatedBlockIsLeftOutInItsChannel) {
    const FitSamples found = samples(1);
    EXPECT_TRUE(std::isnan(found.images[0].signal[0]));
    EXPECT_FALSE(std::isnan(found.images[0].signal[1]));
    EXPECT_FALSE(std::isnan(found.images[0].signal[kChannels]));
    EXPECT_FLOAT_EQ(static_cast<float>(found.images[0].saturated_share),
                    1.0F / (kWidth_px * kHeight_px));
}

class FitSamplesOfAMap : public testing::Test {
  protected:
    void write(const ExrAttributes& attributes, std::vector<float> planes = kEven) const {
        ExrWriter exr(map(), 40, 30, {"R", "G", "B"}, attributes);
        exr.write_rows(30, planes);
        exr.finish();
    }
    [[nodiscard]] std::string map() const { return (folder_.path() / "m.exr").string(); }

    static inline const std::vector<float> kEven =
        std::vector<float>(std::size_t{3} * 40 * 30, 2.0F);
    TempFolder folder_;
    Camera camera_ = fit_rig({}).rig().camera;
};

TEST_F(FitSamplesOfAMap, APoseIsTheMapsOwn) {
    write({{"aphotic:altitude_m", "1.9"}, {"aphotic:pitch_deg", "3"}, {"aphotic:roll_deg", "-2"}});
    const FitSamples found = samples_of_maps({map()}, camera_, 40);
    EXPECT_EQ(found.images[0].sled.altitude_m, 1.9);
    EXPECT_DOUBLE_EQ(found.images[0].sled.pitch_rad, 3.0 * kRadiansPerDegree);
    EXPECT_EQ(found.images[0].signal[0], 2.0F);
}

TEST_F(FitSamplesOfAMap, WhatIsMissingIsNamed) {
    write({{"aphotic:altitude_m", "1.9"}, {"aphotic:pitch_deg", "nan"}, {"aphotic:roll_deg", "0"}});
    EXPECT_TRUE(has(refusal_of([&] { static_cast<void>(samples_of_maps({map()}, camera_, 40)); }),
                    "aphotic:pitch_deg: found 'nan'"));
    camera_.width_px = 41;
    EXPECT_THROW(static_cast<void>(samples_of_maps({map()}, camera_, 40)), InputError);
}

// Fitted without red and blue, water would be told by green alone, and nobody be told.
TEST_F(FitSamplesOfAMap, ThatHasAColourAtItsSitesAloneIsRefused) {
    std::vector<float> planes = kEven;
    for (std::size_t i = 0; i < std::size_t{40} * 30; ++i)
        if (i % 2 == 1 || i / 40 % 2 == 1) planes[i] = std::nanf("");
    write({{"aphotic:altitude_m", "1.9"}, {"aphotic:pitch_deg", "0"}, {"aphotic:roll_deg", "0"}},
          planes);
    const std::string refusal =
        refusal_of([&] { static_cast<void>(samples_of_maps({map()}, camera_, 10)); });
    EXPECT_TRUE(refusal.starts_with(map() + ": found R at too few pixels")) << refusal;
}

// Its three channels are one, and count once.
TEST_F(FitSamplesOfAMap, OfAMonoCameraOneChannelCounts) {
    write({{"aphotic:altitude_m", "1.9"}, {"aphotic:pitch_deg", "0"}, {"aphotic:roll_deg", "0"}});
    camera_.sensor = Sensor::mono(Spectrum("flat", {300.0, 800.0}, {0.5, 0.5}));
    const FitSamples found = samples_of_maps({map()}, camera_, 40);
    EXPECT_EQ(found.images[0].signal[0], 2.0F);
    EXPECT_TRUE(std::isnan(found.images[0].signal[1]));
    EXPECT_TRUE(std::isnan(found.images[0].signal[2]));
}

}  // namespace
}  // namespace aphotic::fit_samples_test
