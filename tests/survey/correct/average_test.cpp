// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/average.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace aphotic::average_test {
namespace {

using Images = std::vector<std::vector<float>>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kFloat = 1e-6;  // a few roundings of a float, relative

Observed running(const Images& images) {
    RunningMean mean(images.front().size());
    for (const std::vector<float>& image : images) mean.add(image);
    return mean.observed();
}

// One place, seen once an image.
Images images_of(const std::vector<float>& samples) {
    Images images;
    for (const float sample : samples) images.push_back({sample});
    return images;
}

// 2, 4, 4, 4, 5, 5, 7, 9: mean 5 and squares about it 32, so s^2 = 32 / 7 and E^2 = 4 / 7.
TEST(Average, MeanOfATextbooksEightSamples) {
    const Observed observed = running(images_of({2, 4, 4, 4, 5, 5, 7, 9}));
    EXPECT_FLOAT_EQ(observed.average[0], 5.0F);
    EXPECT_NEAR(observed.standard_error[0], std::sqrt(4.0 / 7.0), kFloat);
    EXPECT_EQ(observed.count[0], 8.0F);
}

// By hand: trim 0.2 of ten samples cuts 2 a side. Kept 3..8, mean 5.5. Winsorised 3 3 3 4 5 6 7 8 8
// 8, mean 5.5, squares 2 (3 * 2.5^2 + 1.5^2 + 0.5^2) = 42.5; E = sqrt(42.5 / (6 * 5)).
TEST(Average, TrimmedMeanLeavesTheEndsOut) {
    const Images images = images_of({10, 3, 1e6F, 7, 5, 6, 4, 8, -1e6F, 2});
    const Observed observed = average_of(images, Average::Trimmed, 0.2, 1);
    EXPECT_FLOAT_EQ(observed.average[0], 5.5F);
    EXPECT_NEAR(observed.standard_error[0], std::sqrt(42.5 / 30.0), kFloat);
    EXPECT_EQ(observed.count[0], 10.0F);
}

// k = max(1, round(13 - 2.5758 * 2.5)) = 7 of 25: the 7th and the 19th of 1 .. 25.
TEST(Average, MedianAndItsErrorByRanks) {
    std::vector<float> samples;
    for (int i = 0; i < 25; ++i) samples.push_back(static_cast<float>((i * 7) % 25 + 1));
    const Observed odd = average_of(images_of(samples), Average::Median, 0.0, 1);
    EXPECT_FLOAT_EQ(odd.average[0], 13.0F);
    EXPECT_NEAR(odd.standard_error[0], 12.0 / (2.0 * 2.5758), kFloat);

    const Observed even = average_of(images_of({9, 1, 4, 2}), Average::Median, 0.0, 1);
    EXPECT_FLOAT_EQ(even.average[0], 3.0F);
}

TEST(Average, TrimmedByNothingIsTheMean) {
    const Images images = images_of({2.5F, 4, 3.25F, 4, -5, 5, 7, 9.75F});
    const Observed trimmed = average_of(images, Average::Trimmed, 0.0, 1);
    const Observed mean = running(images);
    EXPECT_FLOAT_EQ(trimmed.average[0], mean.average[0]);
    EXPECT_FLOAT_EQ(trimmed.standard_error[0], mean.standard_error[0]);
}

// A float has 24 bits: added up in float, 4000 samples of 10^6 + i % 2 would lose them.
TEST(Average, RunningMeanKeepsSmallChangesOfLargeSamples) {
    Images images;
    for (int i = 0; i < 4000; ++i) images.push_back({1e6F + static_cast<float>(i % 2)});
    const Observed observed = running(images);
    EXPECT_FLOAT_EQ(observed.average[0], 1000000.5F);
    EXPECT_NEAR(observed.standard_error[0], 0.5 / std::sqrt(3999.0), kFloat);
}

TEST(Average, WhatIsNotANumberWasNotObserved) {
    const Images images{{1.0F, kNaN, kNaN}, {kNaN, kNaN, 4.0F}, {3.0F, kNaN, kNaN}};
    for (const Average average : {Average::Mean, Average::Median, Average::Trimmed}) {
        const Observed observed =
            average == Average::Mean ? running(images) : average_of(images, average, 0.1, 1);
        EXPECT_EQ(observed.count, (std::vector<float>{2, 0, 1}));
        EXPECT_FLOAT_EQ(observed.average[0], 2.0F);
        EXPECT_TRUE(std::isnan(observed.average[1]));
        EXPECT_TRUE(std::isnan(observed.standard_error[1]));
        EXPECT_FLOAT_EQ(observed.average[2], 4.0F);
        EXPECT_TRUE(std::isnan(observed.standard_error[2])) << "one sample has no error of its own";
    }
}

// Many places of the same normal distribution: their averages scatter as the errors say.
TEST(Average, AveragesScatterAsTheirErrorsSay) {
    constexpr std::size_t kPlaces = 4000;
    constexpr std::size_t kImages = 101;
    constexpr double kTolerance = 0.06;  // 1 / sqrt(2 places), of the scatter, is 0.011; the rest
                                         // is the median's error, known to be rough
    std::mt19937 random(20261);
    std::normal_distribution<float> normal(5.0F, 2.0F);
    Images images(kImages, std::vector<float>(kPlaces));
    for (std::vector<float>& image : images) {
        for (float& sample : image) sample = normal(random);
    }
    for (const Average average : {Average::Mean, Average::Median, Average::Trimmed}) {
        const Observed observed = average_of(images, average, 0.2, 2);
        double scatter = 0.0;
        double stated = 0.0;
        for (std::size_t i = 0; i < kPlaces; ++i) {
            scatter += std::pow(observed.average[i] - 5.0, 2.0) / kPlaces;
            stated += std::pow(observed.standard_error[i], 2.0) / kPlaces;
        }
        EXPECT_NEAR(std::sqrt(stated / scatter), 1.0, kTolerance) << static_cast<int>(average);
    }
}

TEST(Average, ThreadsChangeNothing) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform;
    Images images(9, std::vector<float>(1001));
    for (std::vector<float>& image : images) {
        for (float& sample : image) sample = uniform(random);
    }
    const Observed one = average_of(images, Average::Trimmed, 0.3, 1);
    for (const int threads : {2, 3, 1000}) {
        const Observed many = average_of(images, Average::Trimmed, 0.3, threads);
        EXPECT_EQ(many.average, one.average) << threads;
        EXPECT_EQ(many.standard_error, one.standard_error) << threads;
    }
}

TEST(Average, SitesOfAMosaicHoldTheirOwnChannel) {
    const RawImage mosaic{.width_px = 2, .height_px = 2, .mosaic = Mosaic::Grbg, .samples = {}};
    EXPECT_EQ(by_channel({1, 2, 3, 4}, mosaic, 0.0F),
              (std::vector<float>{0, 2, 0, 0, 1, 0, 0, 4, 0, 0, 3, 0}));
    const RawImage colours{.width_px = 1, .height_px = 1, .mosaic = Mosaic::None, .samples = {}};
    EXPECT_EQ(by_channel({1, 2, 3}, colours, 0.0F), (std::vector<float>{1, 2, 3}));
}

TEST(Average, DividedByItsMeanAnImageHasMeanOne) {
    RawImage image{
        .width_px = 2, .height_px = 1, .mosaic = Mosaic::None, .samples = {1, 2, kNaN, 3, 4, 10}};
    divide_by_own_mean(image);
    EXPECT_FLOAT_EQ(image.samples[0], 0.25F);
    EXPECT_FLOAT_EQ(image.samples[5], 2.5F);
    image.samples.assign(6, 0.0F);
    EXPECT_THROW(divide_by_own_mean(image), InputError);
}

TEST(Average, SamplesInMemory) {
    EXPECT_EQ(samples_in_memory(500, 272.0), 136000U);  // of 4 bytes each
    EXPECT_EQ(samples_in_memory(500, 1e-6), 1U) << "less than one cannot be held";
}

}  // namespace
}  // namespace aphotic::average_test
