// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/baseline.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace aphotic::baseline_test {
namespace {

constexpr int kWidth_px = 48;
constexpr int kHeight_px = 32;
constexpr double kFloat = 1e-5;  // roundings of floats through fits and logarithms, relative

// Light of each channel, and of each altitude, a low polynomial or its exponential.
template <typename Light>
RawImage image_of(Mosaic mosaic, const Light& light) {
    RawImage image{.width_px = kWidth_px, .height_px = kHeight_px, .mosaic = mosaic, .samples = {}};
    for (int plane = 0; plane < image.planes(); ++plane) {
        for (int row = 0; row < kHeight_px; ++row) {
            for (int column = 0; column < kWidth_px; ++column) {
                const int channel =
                    mosaic == Mosaic::None ? plane : channel_at(mosaic, column, row);
                image.samples.push_back(static_cast<float>(
                    light(channel, (column + 0.5) / kWidth_px, (row + 0.5) / kHeight_px)));
            }
        }
    }
    return image;
}

double slow(int channel, double x, double y) {
    return 2.0 + channel - (1.0 + 0.2 * channel) * (x - 0.5) * (x - 0.5) - 0.8 * y * y * x;
}

// The largest sample of each channel over its least, less 1.
double unevenness(const RawImage& image) {
    double worst = 0.0;
    const RawImage marks =
        image_of(image.mosaic, [](int channel, double, double) { return channel; });
    for (int channel = 0; channel < kChannels; ++channel) {
        float least = 1e30F;
        float most = 0.0F;
        for (std::size_t i = 0; i < image.samples.size(); ++i) {
            if (marks.samples[i] != static_cast<float>(channel)) continue;
            least = std::min(least, image.samples[i]);
            most = std::max(most, image.samples[i]);
        }
        worst = std::max(worst, static_cast<double>(most) / least - 1.0);
    }
    return worst;
}

TEST(Baseline, EveryOneLeavesAConstant) {
    for (const Mosaic mosaic : {Mosaic::None, Mosaic::Rggb}) {
        const RawImage constant =
            image_of(mosaic, [](int channel, double, double) { return 0.5 + channel; });
        for (std::size_t i = 0; i < kBaselineNames.size(); ++i) {
            BaselineCorrector corrector(static_cast<Baseline>(i), {});
            for (int pass = 0; pass < corrector.passes(); ++pass) {
                for (const double altitude_m : {1.0, 1.5, 2.0, 2.5})
                    corrector.learn(constant, altitude_m);
                corrector.end_pass(1);
            }
            const RawImage same = corrector.corrected(constant, 2.0);
            for (std::size_t s = 0; s < same.samples.size(); ++s)
                ASSERT_NEAR(same.samples[s], constant.samples[s], 3.0 * kFloat)
                    << kBaselineNames[i];
        }
    }
}

// Of a mosaic the two green sites lie on one polynomial of the image, so they come out alike but
// for their means over shifted grids; hence red, green and blue of whole images here.
TEST(Baseline, LogPolynomialTakesOneExponentialOfTheSurveyAway) {
    BaselineCorrector corrector(Baseline::LogPolynomial, {});
    const RawImage image =
        image_of(Mosaic::None, [](int c, double x, double y) { return std::exp(slow(c, x, y)); });
    EXPECT_GT(unevenness(image), 0.5);
    corrector.learn(image, 1.0);
    corrector.learn(image, 3.0);
    EXPECT_EQ(corrector.learned(7.0), 2U);
    EXPECT_LT(unevenness(corrector.corrected(image, 2.0)), kFloat);
}

// Four times the light at half the altitude: patterns of their own, and one brightness after.
TEST(Baseline, BinnedPolynomialLevelsEachAltitude) {
    for (const Mosaic mosaic : {Mosaic::None, Mosaic::Bggr}) {
        BaselineCorrector corrector(Baseline::BinnedPolynomial, {});
        const RawImage near =
            image_of(mosaic, [](int c, double x, double y) { return 4.0 * slow(c, x, y); });
        const RawImage far =
            image_of(mosaic, [](int c, double x, double y) { return slow(c, y, 0.3 * x); });
        corrector.learn(near, 1.04);
        corrector.learn(far, 1.96);
        EXPECT_EQ(corrector.learned(0.97), 1U);
        EXPECT_EQ(corrector.learned(1.3), 0U);
        const RawImage a = corrector.corrected(near, 1.0);
        const RawImage b = corrector.corrected(far, 2.0);
        for (std::size_t i = 0; i < a.samples.size(); ++i)
            ASSERT_NEAR(a.samples[i], b.samples[i], 10.0 * kFloat);
        if (mosaic == Mosaic::None) {
            EXPECT_LT(unevenness(a), kFloat);
        }
        EXPECT_THROW((void)corrector.corrected(near, 1.3), InputError);
    }
}

// Light that falls exponentially, at each pixel with a rate of its own, on floors that are as often
// bright as dark: what is left is the floor.
TEST(Baseline, AltitudeExponentialLeavesTheFloor) {
    for (const Mosaic mosaic : {Mosaic::None, Mosaic::Grbg}) {
        const auto image = [&](double altitude_m, double floor) {
            return image_of(mosaic, [&](int c, double x, double y) {
                return floor * slow(c, x, y) * std::exp(-(0.3 + 0.2 * x) * altitude_m);
            });
        };
        BaselineCorrector corrector(Baseline::AltitudeExponential, {});
        for (int pass = 0; pass < corrector.passes(); ++pass) {
            for (const double altitude_m : {1.0, 1.5, 2.0, 2.5, 3.0}) {
                for (const double floor : {0.8, 1.2})
                    corrector.learn(image(altitude_m, floor), altitude_m);
            }
            corrector.end_pass(2);
        }
        EXPECT_EQ(corrector.learned(17.0), 10U);
        const RawImage dark = corrector.corrected(image(1.2, 0.8), 1.2);
        const RawImage bright = corrector.corrected(image(2.7, 1.2), 2.7);
        constexpr double kSearch = 2e-3;  // of b, which ends at 16 bits
        if (mosaic == Mosaic::None) {
            EXPECT_LT(unevenness(dark), kSearch);
        }
        for (std::size_t i = 0; i < dark.samples.size(); ++i)
            ASSERT_NEAR(bright.samples[i] / dark.samples[i], 1.5, kSearch) << i;
    }
}

TEST(Baseline, TakesNothingForLightThatItDidNotLearn) {
    const BaselineCorrector corrector(Baseline::LogPolynomial, {});
    EXPECT_THROW((void)corrector.corrected(image_of(Mosaic::None, slow), 2.0), InputError);
}

}  // namespace
}  // namespace aphotic::baseline_test
