// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_check.h"

#include "support/has.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace aphotic::fit_check_test {
namespace {

constexpr double kLess = 0.98;
constexpr double kMore = 1.02;

// A survey of images from 1 to 3 m, and what a fit might leave of it: nothing to speak of.
struct Fitted {
    FitSamples samples;
    FitResult result;

    Fitted() {
        constexpr int kImages = 20;
        for (int i = 0; i < kImages; ++i) {
            const Sled sled{.altitude_m = 1.0 + 2.0 * i / (kImages - 1)};
            samples.images.push_back({.name = {}, .sled = sled});
            result.left.images.push_back({.sled = sled});
        }
        result.state.beams = {FitBeam::cosine(2.0)};
        result.numbers = {{.number = {.part = FitPart::Water},
                           .key = "water.multiple",
                           .start = 1.0,
                           .value = 1.0,
                           .plausible = 0.1}};
    }

    [[nodiscard]] std::string signs() const {
        std::string all;
        for (const Suspicion& one : suspicions(samples, result)) all += one.about + "\n";
        return all;
    }
};

TEST(FitCheck, AllIsWell) {
    EXPECT_EQ(Fitted().signs(), "");
}

TEST(FitCheck, ResidualsThatStayInPlace) {
    Fitted fitted;
    fitted.result.left.pattern = kLess * kMostPattern;
    EXPECT_EQ(fitted.signs(), "");
    fitted.result.left.pattern = kMore * kMostPattern;
    EXPECT_EQ(fitted.signs(), "pattern\n");
}

// Of even steps from -1 to 1 the rms is sqrt((n + 1) / (3 (n - 1))).
TEST(FitCheck, BrightnessThatGoesWithTheAltitude) {
    Fitted fitted;
    std::vector<ImageOutcome>& images = fitted.result.left.images;
    const auto n = static_cast<double>(images.size());
    const double rms = std::sqrt((n + 1.0) / (3.0 * (n - 1.0)));
    const auto slope = [&](double of_rms) {
        for (ImageOutcome& image : images)
            image.level = of_rms / rms * (image.sled.altitude_m - 2.0);
    };
    slope(kLess * kMostTrend);
    EXPECT_EQ(fitted.signs(), "");
    slope(kMore * kMostTrend);
    EXPECT_EQ(fitted.signs(), "altitude\n");
    // As much, but up and down from image to image.
    for (std::size_t i = 0; i < images.size(); ++i)
        images[i].level = kMore * kMostTrend * (i % 2 == 0 ? 1.0 : -1.0);
    EXPECT_EQ(fitted.signs(), "");
    // Of few images chance does that.
    slope(kMore * kMostTrend);
    images.resize(kFewestImages - 1);
    EXPECT_EQ(fitted.signs(), "");
}

TEST(FitCheck, BrightnessThatNoPoseExplains) {
    Fitted fitted;
    const auto up_and_down = [&](double level) {
        std::vector<ImageOutcome>& images = fitted.result.left.images;
        for (std::size_t i = 0; i < images.size(); ++i)
            images[i].level = i / 2 % 2 == 0 ? level : -level;
    };
    up_and_down(kLess * kMostLevel);
    EXPECT_EQ(fitted.signs(), "");
    up_and_down(kMore * kMostLevel);
    EXPECT_EQ(fitted.signs(), "exposure\n");
}

TEST(FitCheck, NumbersThatAreFarFromTheRigs) {
    Fitted fitted;
    FittedNumber& multiple = fitted.result.numbers.front();
    multiple.value = 1.0 - kLess * kFarthest * multiple.plausible;
    EXPECT_EQ(fitted.signs(), "");
    multiple.value = 1.0 - kMore * kFarthest * multiple.plausible;
    EXPECT_EQ(fitted.signs(), "range\n");
    multiple.value = 1.0;
    multiple.is_at_bound = true;
    EXPECT_EQ(fitted.signs(), "range\n");
    // Nothing of what the rig has some of; and of what it has none of.
    multiple.start = 0.1;
    multiple.value = 0.0;
    EXPECT_EQ(fitted.signs(), "range\n");
    multiple.start = 0.0;
    EXPECT_EQ(fitted.signs(), "");
}

// What is held may be what another number makes up for.
TEST(FitCheck, NumbersAtTheirEndsNameWhatIsHeld) {
    Fitted fitted;
    fitted.result.numbers[0].value = 1.0 + 1.1 * kFarthest * fitted.result.numbers[0].plausible;
    fitted.result.held = {{.key = "water.chlorophyll_mg_m3"}};
    const std::vector<Suspicion> found = suspicions(fitted.samples, fitted.result);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(has(found[0].what, "than the fit allows, another water.chlorophyll_mg_m3, or"));
}

TEST(FitCheck, OneAltitude) {
    Fitted fitted;
    fitted.samples.images.resize(2);
    fitted.samples.images[1].sled.altitude_m = kMore * kOneAltitude;
    EXPECT_EQ(fitted.signs(), "");
    fitted.samples.images[1].sled.altitude_m = kLess * kOneAltitude;
    EXPECT_EQ(fitted.signs(), "altitudes\n");
    fitted.result.numbers.front().number.part = FitPart::LensFactor;
    EXPECT_EQ(fitted.signs(), "altitudes\n");
    // Neither water nor lens, or no beam, to make up for.
    fitted.result.numbers.front().number.part = FitPart::Aim;
    EXPECT_EQ(fitted.signs(), "");
    fitted.result.numbers.front().number.part = FitPart::Water;
    fitted.result.state.beams = {FitBeam::held({})};
    EXPECT_EQ(fitted.signs(), "");
}

TEST(FitCheck, ErrorsAsWideAsWhatIsPlausible) {
    Fitted fitted;
    FittedNumber& one = fitted.result.numbers.front();
    one.error = kLess * kMostError * one.plausible;
    EXPECT_EQ(fitted.signs(), "");
    one.error = kMore * kMostError * one.plausible;
    EXPECT_EQ(fitted.signs(), "errors\n");
}

TEST(FitCheck, TextureThatMapsHaveKept) {
    Fitted fitted;
    fitted.result.left.smooth = kMore * kMostTexture;
    EXPECT_EQ(fitted.signs(), "");
    fitted.samples.are_maps = true;
    EXPECT_EQ(fitted.signs(), "maps\n");
    // Of noise some is shared by chance, and of much noise too much.
    const auto expect_most = [&](double residual, double most) {
        fitted.result.left.residual = residual;
        fitted.result.left.smooth = kLess * most;
        EXPECT_EQ(fitted.signs(), "") << residual;
        fitted.result.left.smooth = kMore * most;
        EXPECT_EQ(fitted.signs(), "maps\n") << residual;
    };
    expect_most(0.0, kLeastTexture);
    expect_most(0.005, kMostShared * 0.005);
    expect_most(0.05, kMostTexture);
}

TEST(FitCheck, SaturatedSamples) {
    Fitted fitted;
    // Of all images: half of them twice as much.
    const auto saturate = [&](double share) {
        for (std::size_t i = 0; i < fitted.samples.images.size(); i += 2)
            fitted.samples.images[i].saturated_share = 2.0 * share;
    };
    saturate(kLess * kMostSaturation);
    EXPECT_EQ(fitted.signs(), "");
    saturate(kMore * kMostSaturation);
    EXPECT_EQ(fitted.signs(), "saturation\n");
}

}  // namespace
}  // namespace aphotic::fit_check_test
