// SPDX-License-Identifier: BSD-3-Clause
#include "survey/dropouts.h"
#include "survey/dropout_check.h"
#include "survey/simulate/floor_texture.h"
#include "survey/simulate/random_draw.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numeric>

namespace aphotic {
namespace {

constexpr double kRounding = 1e-9;
constexpr double kExposure = 500.0;
constexpr std::size_t kImages = 24;

// Two lamps, to the left and to the right: Gaussians of a view of 1.6 m.
CellPlane lamp(double at_m) {
    CellPlane light;
    for (int k = 0; k < kCells * kCells; ++k) {
        const double x_m = 0.1 * (k % kCells + 0.5) - 0.8 - at_m;
        const double y_m = 0.1 * (k / kCells + 0.5) - 0.8;
        light.push_back(std::exp(-(x_m * x_m + y_m * y_m)));
    }
    return light;
}

// Floors of 25 % contrast, each `spread` brighter or darker.
LightCells image_of(std::size_t i, std::uint64_t out = 0, double power = 1.0, double spread = 0.2) {
    LightCells image{.side = kCells, .strobes = {lamp(-0.5), lamp(0.5)}};
    const FloorTexture floor(0.25, i);
    RandomSource random = random_of(1, static_cast<int>(i) + 1);
    const double level = power * std::exp(spread * normal(random));
    for (std::size_t k = 0; k < std::size_t{kCells} * kCells; ++k) {
        double lit = 0.0;
        double all = 0.0;
        for (std::size_t s = 0; s < 2; ++s) {
            all += image.strobes[s][k];
            lit += (out >> s & 1U) == 0 ? image.strobes[s][k] : 0.0;
        }
        const double x_m = 0.1 * static_cast<double>(k % kCells);
        const double y_m = 0.1 * static_cast<double>(k / kCells);
        image.light.push_back(all);
        image.signal.push_back(kExposure * level * floor.at(x_m, y_m) * lit);
    }
    return image;
}

std::vector<LightCells> lit_images(double spread = 0.2) {
    std::vector<LightCells> images;
    for (std::size_t i = 0; i < kImages; ++i) images.push_back(image_of(i, 0, 1.0, spread));
    return images;
}

TEST(Dropouts, ImagesThatAllStrobesLitAreNotNamed) {
    const std::vector<LightCells> images = lit_images();
    const DropoutScales scales = learned(images);
    EXPECT_EQ(scales.images, kImages);
    for (const LightCells& image : images) EXPECT_FALSE(judged(image, scales).is_any());
}

// Both lamps give half of the light in view, by symmetry.
TEST(Dropouts, AStrobeThatDidNotFireIsNamedWithTheShareOfTheOther) {
    const DropoutScales scales = learned(lit_images());
    for (const std::uint64_t out : {1U, 2U}) {
        for (std::size_t i = 100; i < 110; ++i) {
            const Dropout found = judged(image_of(i, out), scales);
            EXPECT_EQ(found.out, out) << i;
            EXPECT_NEAR(found.share, 0.5, kRounding);
            EXPECT_FALSE(found.is_dark);
        }
    }
}

// Half a view of algae that reflect two fifths is no lamp's pattern, whichever half it is.
TEST(Dropouts, ADarkMeadowIsNone) {
    const DropoutScales scales = learned(lit_images());
    for (const bool is_left : {false, true}) {
        LightCells image = image_of(200);
        for (std::size_t k = 0; k < image.signal.size(); ++k)
            if ((k % kCells < kCells / 2) == is_left) image.signal[k] *= 0.4;
        EXPECT_FALSE(judged(image, scales).is_any()) << is_left;
    }
}

// The images of one strobe are learned from as such.
TEST(Dropouts, AThirdOfTheImagesMayLackAStrobe) {
    std::vector<LightCells> images = lit_images();
    for (std::size_t i = 0; i < kImages; i += 3) images[i] = image_of(i, 1);
    const DropoutScales scales = learned(images);
    for (std::size_t i = 0; i < kImages; ++i)
        EXPECT_EQ(judged(images[i], scales).out, i % 3 == 0 ? 1U : 0U) << i;
}

// Without maps: levels of 1, but for three of 0.015 and one of 0.5.
std::vector<LightCells> even_images(double spread) {
    std::vector<LightCells> images;
    RandomSource random = random_of(2, 1);
    for (std::size_t i = 0; i < 12; ++i) {
        const double level = i < 8 ? std::exp(spread * normal(random)) : i < 11 ? 0.015 : 0.5;
        images.push_back(
            {.side = 2, .signal = CellPlane(4, kExposure * level), .light = CellPlane(4, 1.0)});
    }
    return images;
}

TEST(Dropouts, WithoutMapsTheLevelTellsWhatFloorsAlikeDoNot) {
    const std::vector<LightCells> images = even_images(1e-3);
    const DropoutScales scales = learned(images);
    constexpr double kLevels = 3e-3;  // of the floors
    for (std::size_t i = 0; i < 8; ++i) EXPECT_FALSE(judged(images[i], scales).is_any()) << i;
    for (std::size_t i = 8; i < 11; ++i) {
        EXPECT_TRUE(judged(images[i], scales).is_dark) << i;
        EXPECT_NEAR(judged(images[i], scales).share, 0.015, 0.015 * kLevels) << i;
    }
    EXPECT_FALSE(judged(images[11], scales).is_dark);
    EXPECT_NEAR(judged(images[11], scales).share, 0.5, 0.5 * kLevels);
}

TEST(Dropouts, HalfTheLightIsAFloorWhereFloorsDiffer) {
    const std::vector<LightCells> images = even_images(0.3);
    const DropoutScales scales = learned(images);
    EXPECT_TRUE(judged(images[8], scales).is_dark);
    EXPECT_FALSE(judged(images[11], scales).is_any());
}

// 2.5 ln(1 + x^2 / (4 psi^2)) + ln(psi / (0.375 ln 30)) = ln(2 / 0.01) at shares of exp(-x).
TEST(Dropouts, HowDimAnImageMustBeGoesByTheFloorsSpread) {
    const auto is_told = [](double share, double spread) {
        const DropoutScales scales{.images = 100, .level = 0.0, .spread = spread, .detail = {0.1}};
        const LightCells image{
            .side = 2, .signal = CellPlane(4, share), .light = CellPlane(4, 1.0)};
        return judged(image, scales).is_any();
    };
    EXPECT_TRUE(is_told(0.14, 0.25));
    EXPECT_FALSE(is_told(0.15, 0.25));
    EXPECT_TRUE(is_told(0.76, 0.02));
    EXPECT_FALSE(is_told(0.78, 0.02));
}

TEST(Dropouts, OfThreeImagesTheLevelTellsOnlyWhatIsWithoutLight) {
    std::vector<LightCells> images = even_images(1e-3);
    images = {images[0], images[11], images[1], images[8]};
    const DropoutScales scales = learned(images);
    EXPECT_FALSE(judged(images[1], scales).is_any());
    EXPECT_TRUE(judged(images[3], scales).is_dark);
}

TEST(Dropouts, FewImagesWithoutAMapAreNotJudged) {
    std::vector<LightCells> images = even_images(1e-3);
    for (LightCells& image : images) image.has_map = false;
    EXPECT_EQ(learned(std::span(images).last(7)).images, 0U);
    EXPECT_GT(learned(std::span(images).last(8)).images, 0U);
}

TEST(Dropouts, WhereMostImagesAreDarkTheLitAreTheSurvey) {
    std::vector<LightCells> images = even_images(1e-3);
    for (std::size_t i = 2; i < 8; ++i) images.push_back(images[8]);
    images.erase(images.begin() + 2, images.begin() + 8);
    const DropoutScales scales = learned(images);
    EXPECT_FALSE(judged(images[0], scales).is_any());
    EXPECT_TRUE(judged(images.back(), scales).is_dark);
}

// Exposures from 1 to 1/8 are told as each image's level.
TEST(Dropouts, OfExposuresOfTheirOwnImagesHaveTheirLevel) {
    std::vector<LightCells> images = even_images(0.0);
    images.resize(8);
    for (std::size_t i = 0; i < 8; ++i)
        for (double& signal : images[i].signal) signal *= std::exp2(-static_cast<double>(i % 4));
    const DropoutScales scales = learned(images, true);
    constexpr double kStrayed = 0.02;  // what kStray adds to an eighth of the light
    for (std::size_t i = 0; i < 8; ++i) {
        const Dropout found = judged(images[i], scales);
        EXPECT_FALSE(found.is_any());
        EXPECT_NEAR(found.level - judged(images[0], scales).level,
                    -std::log(2.0) * static_cast<double>(i % 4),
                    kStrayed);
    }
}

TEST(Dropouts, MostImagesWithoutAStrobeAreAnotherRig) {
    std::vector<LightCells> images = lit_images();
    for (std::size_t i = 0; i < kImages; ++i)
        if (i % 3 > 0) images[i] = image_of(i, 1);
    DropoutScales scales = learned(images);
    Survey survey;
    survey.strobes.names = {"fore", "aft"};
    const auto doubt = doubt_of_rig(images, survey, scales);
    ASSERT_TRUE(doubt.has_value());
    EXPECT_EQ(doubt->about, "strobes");
    EXPECT_NE(doubt->what.find("16 of 24 images look as if fore had not fired"), std::string::npos)
        << doubt->what;
    EXPECT_FALSE(judged(images[1], scales).is_any());
}

// Greens of 4 i at column i, red and blue of 1e4; over a black level of 100, at twice the light.
TEST(Dropouts, CellsAreMeansOfGreen) {
    constexpr int kWide = 128;
    constexpr int kHigh = 64;
    SurveyImage taken;
    taken.raw = {.width_px = kWide, .height_px = kHigh, .mosaic = Mosaic::Grbg};
    taken.levels = {.black = 100.0F, .white = 20000.0F};
    taken.exposure = 2.0;
    for (int row = 0; row < kHigh; ++row)
        for (int column = 0; column < kWide; ++column)
            taken.raw.samples.push_back(
                (row + column) % 2 == 0 ? 100.0F + 4.0F * static_cast<float>(column) : 1e4F);
    taken.raw.samples[0] = 3e4F;  // one of the cell's sixteen greens is saturated
    const CellPlane cells = cells_of(taken, cells_across(kWide, kHigh));
    ASSERT_EQ(cells.size(), 256U);
    EXPECT_TRUE(std::isnan(cells[0]));
    for (std::size_t k = 1; k < cells.size(); ++k)
        ASSERT_NEAR(cells[k], 2.0 * (8.0 * static_cast<double>(k % 16) + 3.5), kRounding) << k;
}

TEST(Dropouts, WordsNameStrobesAndShare) {
    EXPECT_EQ(words_of(marked("a", {"fore", "aft"}, 0.74, 2)),
              "strobe aft did not fire: lit by 0.74 of the survey's light");
    EXPECT_EQ(words_of(marked("a", {}, 0.5, 0)), "lit by 0.5 of the survey's light");
}

}  // namespace
}  // namespace aphotic
