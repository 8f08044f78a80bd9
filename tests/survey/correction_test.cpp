// SPDX-License-Identifier: BSD-3-Clause
//
// What is made of known light must come back: raw = black + exposure * reflectance * light, so
// that the division has a closed form. The light here is made by hand, not by the maps' own code.
#include "survey/correction.h"

#include "base/error.h"
#include "support/has.h"
#include "support/refusal.h"
#include "survey/light_at.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace aphotic::correction_test {
namespace {

constexpr int kWidth = 33;
constexpr int kHeight = 21;
constexpr std::size_t kPixels = kWidth * kHeight;
constexpr float kBlackLevel = 64.0F;
constexpr double kExposure = 3000.0;  // numbers per unit of signal
// Four operations on floats, each of them to half of 2^-23.
constexpr double kRounding = 4 * 0x1p-23;

// Brightest in the middle; a hundredth of it in the corners, less in each channel after the first.
Lightmap light_of_a_lamp() {
    Lightmap map{.width_px = kWidth, .height_px = kHeight, .samples = {}};
    for (int c = 0; c < kChannels; ++c) {
        for (int row = 0; row < kHeight; ++row) {
            for (int column = 0; column < kWidth; ++column) {
                const double x = (column - kWidth / 2) / (0.5 * kWidth);
                const double y = (row - kHeight / 2) / (0.5 * kHeight);
                map.samples.push_back(
                    static_cast<float>(std::exp(-2.5 * (x * x + y * y)) / (1.0 + c)));
            }
        }
    }
    return map;
}

std::vector<float> random_reflectance(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> share(0.05F, 0.9F);
    std::vector<float> reflectance(kChannels * kPixels);
    std::ranges::generate(reflectance, [&] { return share(random); });
    return reflectance;
}

// Of planes R, G, B those samples that the mosaic's sites see.
std::vector<float> at_sites(const std::vector<float>& planes, Mosaic mosaic) {
    if (mosaic == Mosaic::None) return planes;
    std::vector<float> sites;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const int channel =
            channel_at(mosaic, static_cast<int>(i) % kWidth, static_cast<int>(i) / kWidth);
        sites.push_back(planes[static_cast<std::size_t>(channel) * kPixels + i]);
    }
    return sites;
}

RawImage seen(const Lightmap& map, const std::vector<float>& reflectance, Mosaic mosaic) {
    std::vector<float> samples(reflectance.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = static_cast<float>(kBlackLevel + kExposure * reflectance[i] * map.samples[i]);
    }
    return {.width_px = kWidth,
            .height_px = kHeight,
            .mosaic = mosaic,
            .samples = at_sites(samples, mosaic)};
}

Correction plain() {
    const double gain = 1.0 / kExposure;
    return {
        .gain = {gain, gain, gain},
        .middle = {0.5, 0.5, 0.5},
        .levels = {.black = kBlackLevel, .white = 4095.0F},
        .limit = {.share = 1e-6, .relative = 1.0, .read_noise = 0.0, .electrons_per_number = 0.0}};
}

TEST(Correction, WhatWasLitComesBackInEveryLayout) {
    const Lightmap map = light_of_a_lamp();
    for (const Mosaic mosaic :
         {Mosaic::None, Mosaic::Rggb, Mosaic::Bggr, Mosaic::Grbg, Mosaic::Gbrg}) {
        const std::vector<float> reflectance = random_reflectance(7);
        const CorrectedImage result = corrected(seen(map, reflectance, mosaic), map, plain());
        const std::vector<float> wanted = at_sites(reflectance, mosaic);
        ASSERT_EQ(result.image.samples.size(), wanted.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            // The raw sample's own rounding counts by as much as the black level lifts it; the
            // last channel has a third of the first one's light.
            const double least_raw = wanted[i] * kExposure * map.samples[i % kPixels] / kChannels;
            EXPECT_NEAR(result.image.samples[i],
                        wanted[i],
                        kRounding * wanted[i] * (1.0 + kBlackLevel / least_raw))
                << mosaic_name(mosaic) << ' ' << i;
        }
        EXPECT_EQ(std::ranges::count(result.doubts, 0), std::ssize(result.doubts));
    }
}

TEST(Correction, WholeNumbersCostHalfAStepOfTheirOwnGain) {
    const Lightmap map = light_of_a_lamp();
    const std::vector<float> reflectance = random_reflectance(8);
    RawImage raw = seen(map, reflectance, Mosaic::None);
    for (float& sample : raw.samples) sample = std::round(sample);
    const CorrectedImage result = corrected(raw, map, plain());
    double largest = 0.0;
    for (std::size_t i = 0; i < reflectance.size(); ++i) {
        const double half_a_step = 0.5 / (kExposure * map.samples[i]);
        const double error = std::abs(result.image.samples[i] - reflectance[i]);
        EXPECT_LE(error, half_a_step * (1.0 + 1e-3)) << i;  // and the floats' own rounding
        largest = std::max(largest, error / half_a_step);
    }
    EXPECT_GT(largest, 0.9);  // the bound is no looser than it must be
}

TEST(Correction, TheGainIsHeldWhereTheMapIsDark) {
    constexpr float kShare = 0.2F;
    const Lightmap map = light_of_a_lamp();
    Correction held = plain();
    held.limit.share = kShare;
    // Even numbers, as of noise: corrected they must not rise over gain / (share of the brightest).
    const RawImage raw{.width_px = kWidth,
                       .height_px = kHeight,
                       .mosaic = Mosaic::None,
                       .samples = std::vector<float>(kChannels * kPixels, kBlackLevel + 30.0F)};
    const CorrectedImage result = corrected(raw, map, held);
    for (std::size_t i = 0; i < raw.samples.size(); ++i) {
        const auto brightest = 1.0F / static_cast<float>(1 + i / kPixels);
        const double most = 30.0 / (kExposure * kShare * brightest);
        EXPECT_LE(result.image.samples[i], most * (1.0 + kRounding));
        const bool is_dark = map.samples[i % kPixels] < kShare;  // alike in all three channels
        EXPECT_EQ(result.doubts[i % kPixels], is_dark ? kDark : 0) << i;
        if (is_dark) {
            EXPECT_NEAR(result.image.samples[i], most, kRounding * most);
        }
    }
}

// Green and blue everywhere alike; a red that fades as in water, from 1 to a thousandth.
Lightmap light_through_water() {
    Lightmap map{.width_px = kWidth, .height_px = kHeight, .samples = {}};
    for (std::size_t i = 0; i < kPixels; ++i) {
        map.samples.push_back(std::pow(10.0F, -3.0F * static_cast<float>(i) / kPixels));
    }
    map.samples.insert(map.samples.end(), kPixels, 1.0F / 2.0F);
    map.samples.insert(map.samples.end(), kPixels, 1.0F / 3.0F);
    return map;
}

// With one gain held and not the others, a grey floor would turn green in the dark.
TEST(Correction, WhereOneChannelIsTooDarkAPixelKeepsItsColour) {
    constexpr double kShare = 0.1;
    const Lightmap map = light_through_water();
    const std::vector<float> reflectance = random_reflectance(11);
    Correction held = plain();
    held.levels.black = 0.0F;
    held.limit.share = kShare;
    const PerChannel brightest{1.0, 1.0 / 2.0, 1.0 / 3.0};
    RawImage raw = seen(map, reflectance, Mosaic::None);
    for (float& sample : raw.samples) sample -= kBlackLevel;
    const CorrectedImage result = corrected(raw, map, held);
    std::size_t dark = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const double red_share = map.samples[i] / kShare;
        EXPECT_EQ(result.doubts[i] == kDark, red_share < 1.0) << i;
        if (red_share < 1.0) ++dark;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const std::size_t at = c * kPixels + i;
            // The closed form of h where red is the darkest.
            const double wanted = reflectance[at] * std::min(1.0, red_share);
            // The raw sample lost what lay under a step of the black level that it was made with.
            const double lost = 0x1p-23 * kBlackLevel / (kExposure * map.samples[at]);
            EXPECT_NEAR(result.image.samples[at], wanted, 4 * kRounding * wanted + lost) << i;
            const double most = raw.samples[at] / (kExposure * kShare * brightest[c]);
            EXPECT_LE(result.image.samples[at], most * (1.0 + kRounding)) << i;
        }
    }
    EXPECT_GT(dark, kPixels / 4);
    EXPECT_LT(dark, 3 * kPixels / 4);
}

// An observed mosaic tells of each site its own channel alone, and 0 in the two others.
TEST(Correction, ChannelsThatTheMapDoesNotTellHoldNothing) {
    Lightmap map = light_of_a_lamp();
    const std::vector<float> reflectance = random_reflectance(12);
    const RawImage raw = seen(map, reflectance, Mosaic::Rggb);
    const CorrectedImage whole = corrected(raw, map, plain());
    for (std::size_t i = 0; i < map.samples.size(); ++i) {
        const auto pixel = static_cast<int>(i % kPixels);
        if (channel_at(Mosaic::Rggb, pixel % kWidth, pixel / kWidth) !=
            static_cast<int>(i / kPixels)) {
            map.samples[i] = 0.0F;
        }
    }
    const CorrectedImage sites = corrected(raw, map, plain());
    EXPECT_EQ(sites.image.samples, whole.image.samples);
    EXPECT_EQ(sites.doubts, whole.doubts);
}

// Without shot noise the relative noise is r/s; without read noise it is 1/sqrt(e s).
TEST(Correction, TheLeastSignalIsWhereNoiseReachesTheLimit) {
    NoiseLimit limit{.share = 0.0, .relative = 0.1, .read_noise = 3.0, .electrons_per_number = 0.0};
    EXPECT_DOUBLE_EQ(least_signal(limit), 30.0);
    limit.read_noise = 0.0;
    limit.electrons_per_number = 4.0;
    EXPECT_DOUBLE_EQ(least_signal(limit), 25.0);
    limit.read_noise = 3.0;
    const double s = least_signal(limit);
    EXPECT_NEAR(std::sqrt(9.0 + s / 4.0) / s, 0.1, 1e-12);
    constexpr double kVeil = 500.0;
    const double beside = least_signal(limit, kVeil);
    EXPECT_NEAR(std::sqrt(9.0 + (beside + kVeil) / 4.0) / beside, 0.1, 1e-12);
}

// raw = black + E (rho map + veil): brighter in a corner than the floor is.
Lightmap with_veil(Lightmap map) {
    for (int c = 0; c < kChannels; ++c) {
        for (int row = 0; row < kHeight; ++row) {
            for (int column = 0; column < kWidth; ++column)
                map.veil.push_back(0.02F * static_cast<float>(1 + c + row + 2 * column) / kWidth);
        }
    }
    return map;
}

RawImage seen_through(const Lightmap& map, const std::vector<float>& reflectance) {
    RawImage raw = seen(map, reflectance, Mosaic::None);
    for (std::size_t i = 0; i < raw.samples.size(); ++i)
        raw.samples[i] += static_cast<float>(kExposure * map.veil[i]);
    return raw;
}

Correction of_exposure() {
    Correction correction = plain();
    correction.middle = {1.0, 1.0, 1.0};  // so that middle / gain is the exposure
    return correction;
}

TEST(Correction, TheVeilIsTakenOff) {
    const Lightmap map = with_veil(light_of_a_lamp());
    const std::vector<float> reflectance = random_reflectance(31);
    const RawImage raw = seen_through(map, reflectance);
    const CorrectedImage result = corrected(raw, map, of_exposure());
    double worst_without = 0.0;
    const CorrectedImage without = corrected(
        raw, {.width_px = kWidth, .height_px = kHeight, .samples = map.samples}, of_exposure());
    for (std::size_t i = 0; i < reflectance.size(); ++i) {
        const double floor = kExposure * reflectance[i] * map.samples[i];
        const double raw_rounding = 2.0 * raw.samples[i] * 0x1p-23;
        EXPECT_NEAR(result.image.samples[i],
                    reflectance[i],
                    reflectance[i] * (kRounding + raw_rounding / floor))
            << i;
        worst_without =
            std::max(worst_without, static_cast<double>(without.image.samples[i] - reflectance[i]));
    }
    EXPECT_GT(worst_without, 1.0);
    EXPECT_EQ(std::ranges::count(result.doubts, 0), std::ssize(result.doubts));
}

// Nothing is clamped: what is under the veil is negative, and doubtful.
TEST(Correction, WhatIsUnderTheVeilIsBlack) {
    const Lightmap map = with_veil(light_of_a_lamp());
    RawImage raw = seen_through(map, std::vector<float>(kChannels * kPixels, 0.0F));
    for (float& sample : raw.samples) sample -= 1.0F;
    const CorrectedImage result = corrected(raw, map, of_exposure());
    for (const std::uint8_t doubts : result.doubts) EXPECT_TRUE(doubts & kBlack);
    for (const float sample : result.image.samples) EXPECT_LT(sample, 0.0F);
}

// Simulated noise where the map is just at the limit: the corrected floor's spread is what the
// limit says.
TEST(Correction, AtTheLimitTheNoiseIsTheLimit) {
    constexpr double kReadNoise = 4.0;
    constexpr double kLimit = 0.08;
    constexpr double kMiddle = 0.3;
    Correction correction = plain();
    correction.middle = {kMiddle, kMiddle, kMiddle};
    correction.limit = {
        .share = 0.0, .relative = kLimit, .read_noise = kReadNoise, .electrons_per_number = 0.0};
    const auto light = static_cast<float>(kReadNoise / kLimit / (kExposure * kMiddle));
    constexpr int kSide = 200;
    const std::size_t samples = std::size_t{kChannels} * kSide * kSide;
    for (const float around : {0.999F, 1.001F}) {
        const Lightmap map{.width_px = kSide,
                           .height_px = kSide,
                           .samples = std::vector<float>(samples, light * around)};
        RawImage raw{.width_px = kSide, .height_px = kSide, .mosaic = Mosaic::None, .samples = {}};
        std::mt19937 random(3);
        std::normal_distribution<double> noise(kBlackLevel + kReadNoise / kLimit, kReadNoise);
        for (std::size_t i = 0; i < samples; ++i) {
            raw.samples.push_back(static_cast<float>(noise(random)));
        }
        const CorrectedImage result = corrected(raw, map, correction);
        double sum = 0.0;
        double squares = 0.0;
        for (const float sample : result.image.samples) {
            sum += sample;
            squares += static_cast<double>(sample) * sample;
        }
        const double mean = sum / static_cast<double>(samples);
        const double spread = std::sqrt(squares / static_cast<double>(samples) - mean * mean);
        // Of 120000 samples the spread is known to 0.2 %; 1 % is five times that.
        EXPECT_NEAR(spread / mean, kLimit, 0.01 * kLimit);
        EXPECT_NEAR(mean, kMiddle, 0.01 * kMiddle);
        EXPECT_EQ((result.doubts[0] & kDark) != 0, around < 1.0F);
    }
}

TEST(Correction, SaturatedAndBlackPixelsAreMarked) {
    const Lightmap map{.width_px = 2, .height_px = 2, .samples = std::vector<float>(12, 1.0F)};
    const RawImage raw{.width_px = 2,
                       .height_px = 2,
                       .mosaic = Mosaic::Gbrg,
                       .samples = {4095.0F, 4094.0F, 64.0F, 10.0F}};
    const CorrectedImage result = corrected(raw, map, plain());
    EXPECT_EQ(result.doubts, (std::vector<std::uint8_t>{kSaturated, 0, kBlack, kBlack}));
    EXPECT_LT(result.image.samples[3], 0.0F);  // noise about black stays noise about 0
    // Between the sites of a 2 x 2 mosaic, each pixel is made of all.
    const CorrectedImage whole = demosaiced(result);
    EXPECT_EQ(whole.doubts, std::vector<std::uint8_t>(4, kSaturated | kBlack));
    EXPECT_EQ(whole.image.samples.size(), 12U);
}

TEST(Correction, ABlackMapGivesBlackAndNoFault) {
    const Lightmap map{.width_px = 2, .height_px = 2, .samples = std::vector<float>(12, 0.0F)};
    const RawImage raw{.width_px = 2,
                       .height_px = 2,
                       .mosaic = Mosaic::None,
                       .samples = std::vector<float>(12, 500.0F)};
    const CorrectedImage result = corrected(raw, map, plain());
    EXPECT_EQ(result.image.samples, std::vector<float>(12, 0.0F));
    EXPECT_EQ(result.doubts, std::vector<std::uint8_t>(4, kDark));
    EXPECT_TRUE(std::isnan(middle_quotient(raw, map, plain().levels, 0.01)[0]));
}

TEST(Correction, WhatCannotBeCorrectedIsRefused) {
    const Lightmap map = light_of_a_lamp();
    const auto fault_of = [&](const RawImage& raw, const Correction& correction) -> std::string {
        return refusal_of([&] { return corrected(raw, map, correction); });
    };
    RawImage raw = seen(map, random_reflectance(9), Mosaic::None);
    Correction wild = plain();
    wild.gain = {1e39, 1e39, 1e39};
    EXPECT_TRUE(has(fault_of(raw, wild), "the corrected image is inf"));
    raw.samples[kWidth + 2] = std::nanf("");
    EXPECT_EQ(fault_of(raw, plain()), "the image is nan at sample 2, 1; allowed: finite numbers");
    raw.width_px = kHeight;
    raw.height_px = kWidth;
    EXPECT_EQ(fault_of(raw, plain()), "found 21 x 33 pixels; allowed: 33 x 21, like the map");
}

// Half of the pixels reflect less than the middle and half more; extremes do not move it.
TEST(Correction, TheMiddleIsTheMedianOfWhatTheLightMakesGood) {
    const Lightmap map = light_of_a_lamp();
    std::vector<float> reflectance(kChannels * kPixels);
    for (std::size_t i = 0; i < reflectance.size(); ++i) {
        reflectance[i] = 0.2F + 0.2F * static_cast<float>(i % 101) / 100.0F;
    }
    RawImage raw = seen(map, reflectance, Mosaic::None);
    for (std::size_t i = 0; i < 60; ++i) {
        raw.samples[i * 7] = 4095.0F;    // saturated
        raw.samples[i * 7 + 1] = 64.0F;  // black
    }
    const PerChannel middle = middle_quotient(raw, map, plain().levels, 0.05);
    for (const double quotient : middle) {
        // The 101 values stand 0.002 apart; leaving some out shifts the median by few of them.
        EXPECT_NEAR(quotient / kExposure, 0.3, 0.01);
    }
}

Spectrum straight(double first, double last) {
    return {"straight", {400.0, 700.0}, {first, last}};
}

Rig rig_of_floor(const Spectrum& reflectance) {
    const Strobe strobe{.name = "lamp",
                        .position_m = {0.0, 0.0, 0.0},
                        .axis = Eigen::Vector3d::UnitZ(),
                        .beam = {},
                        .spectrum = straight(1.0, 1.0),
                        .power = 2.0,
                        .emitter = std::nullopt};
    return {
        .title = "",
        .sled = {},
        .camera = {.width_px = 1,
                   .height_px = 1,
                   .pixel_pitch_m = 1.0,
                   .focal_length_m = 1.0,
                   .range = {400.0, 700.0},
                   .sensor = Sensor({straight(1.0, 1.0), straight(0.0, 1.0), straight(1.0, 0.0)},
                                    ResponseKind::Energy),
                   .port = std::nullopt},
        .water = {.absorption_per_m = straight(0.1, 0.5)},
        .seafloor = {.reflectance = reflectance},
        .strobes = {strobe},
        .digest = ""};
}

// Over 0 to 1: int x dx = 1/2, int x^2 dx = 1/3, int x (1-x) dx = 1/6. The water has no say.
TEST(Correction, TheFloorsColourIsItsMeanOverChannelAndLamps) {
    constexpr double kSpectralError = 1e-6;  // of floor_colour's grid
    const PerChannel grey = floor_colour(rig_of_floor(straight(0.18, 0.18)));
    for (const double channel : grey) EXPECT_NEAR(channel, 0.18, kSpectralError);
    const PerChannel red = floor_colour(rig_of_floor(straight(0.0, 1.0)));
    EXPECT_NEAR(red[0], 1.0 / 2.0, kSpectralError);
    EXPECT_NEAR(red[1], 2.0 / 3.0, kSpectralError);
    EXPECT_NEAR(red[2], 1.0 / 3.0, kSpectralError);
}

}  // namespace
}  // namespace aphotic::correction_test
