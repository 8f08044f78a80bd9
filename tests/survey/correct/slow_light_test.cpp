// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/slow_light.h"

#include "survey/correct/polynomial_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

namespace aphotic::slow_light_test {
namespace {

using Samples = std::vector<float>;

constexpr int kWidth_px = 160;
constexpr int kHeight_px = 96;
constexpr double kSigma_px = 16.0;
constexpr double kFloat = 1e-5;  // roundings of floats through a logarithm and back, relative

template <typename Function>
Samples plane_of(const Function& f) {
    Samples plane;
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column)
            plane.push_back(
                static_cast<float>(f((column + 0.5) / kWidth_px, (row + 0.5) / kHeight_px)));
    }
    return plane;
}

// Every baseline of one image, and the fitted two on the image alone.
struct Baseline {
    const char* name;
    std::function<Samples(const Samples&)> correct;
};
Samples fitted(const Samples& plane) {
    PolynomialSurface surface(kWidth_px, kHeight_px, 4);
    surface.add(plane);
    return surface.fitted();
}
std::vector<Baseline> baselines() {
    return {{"illumination-reflectance",
             [](const Samples& p) { return illumination_reflectance(p, kWidth_px, kSigma_px); }},
            {"homomorphic",
             [](const Samples& p) {
                 return homomorphic(p, kWidth_px, {.sigma_px = kSigma_px, .low = 0.3, .high = 1.2});
             }},
            {"equalisation", [](const Samples& p) { return locally_equalised(p, kWidth_px, {}); }},
            {"log-polynomial",
             [](const Samples& p) {
                 return divided_by_pattern(p, exponentials(fitted(logarithms(p))));
             }},
            {"polynomial", [](const Samples& p) { return divided_by_pattern(p, fitted(p)); }}};
}

TEST(Baselines, ScaleWithTheImage) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0.01F, 1.0F);
    const Samples image = plane_of([&](double, double) { return uniform(random); });
    Samples brighter = image;
    for (float& sample : brighter) sample *= 640.0F;
    for (const Baseline& baseline : baselines()) {
        const Samples once = baseline.correct(image);
        const Samples twice = baseline.correct(brighter);
        for (std::size_t i = 0; i < once.size(); ++i)
            ASSERT_NEAR(twice[i] / 640.0, once[i], kFloat) << baseline.name;
    }
}

// What black and white noise, and black alone, come to is finite.
TEST(Baselines, NeverBlowUp) {
    std::mt19937 random(6);
    const Samples speckle =
        plane_of([&](double x, double) { return x > 0.5 && random() % 2 == 0 ? 4095.0 : 0.0; });
    const Samples black(speckle.size(), 0.0F);
    for (const Baseline& baseline : baselines()) {
        for (const Samples& image : {speckle, black}) {
            for (const float sample : baseline.correct(image))
                ASSERT_TRUE(std::isfinite(sample)) << baseline.name;
        }
    }
    Samples pattern(speckle.size(), 1.0F);
    pattern[0] = -3.0F;
    const Samples ones(speckle.size(), 1.0F);
    EXPECT_NEAR(divided_by_pattern(ones, pattern)[0], 1.0 / kLeastShare, 0.01 / kLeastShare);
}

// How much a Gaussian leaves of half a wave across the image.
constexpr double kWave = std::numbers::pi / kWidth_px * kSigma_px;  // radians over one sigma
const double kLeft = std::exp(-kWave * kWave / 2.0);
constexpr double kBell = 2e-4;  // of five boxes against the Gaussian at so long a wave:
                                // (1.2 / 5) kWave^4 / 24, 1e-4, and roundings

// Half a cosine across, mirrored at the border, is a cosine: a blur lowers it and leaves its shape.
TEST(Baselines, IlluminationReflectanceDividesByTheSlowPart) {
    const auto cosine = [](double x) { return std::cos(std::numbers::pi * x); };
    const Samples image = plane_of([&](double x, double) { return 1.0 + 0.5 * cosine(x); });
    const Samples corrected = illumination_reflectance(image, kWidth_px, kSigma_px);
    const Samples wanted = plane_of([&](double x, double) {
        return (1.0 + 0.5 * cosine(x)) / (1.0 + 0.5 * kLeft * cosine(x));
    });
    for (std::size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(corrected[i], wanted[i], kBell);
}

TEST(Baselines, HomomorphicTurnsTheLogarithmsSlowPartDown) {
    constexpr double kLow = 0.3;
    constexpr double kHigh = 1.4;
    const auto cosine = [](double x) { return std::cos(std::numbers::pi * x); };
    const Samples image = plane_of([&](double x, double) { return std::exp(cosine(x)); });
    const Samples corrected =
        homomorphic(image, kWidth_px, {.sigma_px = kSigma_px, .low = kLow, .high = kHigh});
    const double amplitude = kLow * kLeft + kHigh * (1.0 - kLeft);
    const Samples wanted =
        plane_of([&](double x, double) { return std::exp(amplitude * cosine(x)); });
    for (std::size_t i = 0; i < image.size(); ++i)
        ASSERT_NEAR(corrected[i] / wanted[i], 1.0, 2.0 * kBell);
    const Samples same =
        homomorphic(image, kWidth_px, {.sigma_px = kSigma_px, .low = 1.0, .high = 1.0});
    for (std::size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(same[i] / image[i], 1.0, kFloat);
}

// With one tile and no clip: any rising curve comes to the share of pixels below, a straight ramp.
TEST(LocalEqualisation, OfOneTileFlattensTheHistogram) {
    constexpr double kBin = 1.0 / kBins + 1.0 / kWidth_px;  // two samples of one bin; one column
    const Samples bent = plane_of([](double x, double) { return std::sqrt(x); });
    const Samples even = locally_equalised(bent, kWidth_px, {.tiles = 1, .clip = 1e9});
    const auto [least, most] = std::ranges::minmax(bent);
    const Samples wanted =
        plane_of([&, a = least, b = most](double x, double) { return a + (b - a) * x; });
    for (std::size_t i = 0; i < even.size(); ++i) ASSERT_NEAR(even[i], wanted[i], kBin);
}

TEST(LocalEqualisation, ClippedAtTheMeanChangesNothing) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> uniform;
    Samples image = plane_of([&](double x, double) { return x * uniform(random); });
    const Samples same = locally_equalised(image, kWidth_px, {.tiles = 3, .clip = 1e-9});
    for (std::size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(same[i], image[i], kFloat);
}

// Light that falls off in steps between tiles: each tile's own texture ends up as bright.
TEST(LocalEqualisation, GivesEveryPartTheSameBrightness) {
    constexpr double kEven = 0.1;  // of the range; the tiles' borders blend
    std::mt19937 random(9);
    std::uniform_real_distribution<float> uniform(0.5F, 1.0F);
    const Samples image =
        plane_of([&](double x, double) { return (1.0 - 0.8 * x) * uniform(random); });
    const auto halves = [](const Samples& plane) {
        std::array<double, 2> means{};
        for (std::size_t i = 0; i < plane.size(); ++i)
            means.at(i % kWidth_px < kWidth_px / 2 ? 0 : 1) +=
                2.0 * plane[i] / static_cast<double>(plane.size());
        return means;
    };
    const auto before = halves(image);
    const auto after = halves(locally_equalised(image, kWidth_px, {.tiles = 8, .clip = 1e9}));
    EXPECT_GT(before[0] / before[1], 1.9) << "0.8 to 0.4 on average, were it not for this test's";
    EXPECT_NEAR(after[0], after[1], kEven);
}

}  // namespace
}  // namespace aphotic::slow_light_test

namespace aphotic::gaussian_blur_test {
namespace {

constexpr double kFloat = 1e-6;  // a few roundings of a float, relative

// Mirrored borders send back what would leave.
TEST(GaussianBlur, KeepsTheMean) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform;
    std::vector<float> plane(31 * 17);
    for (float& sample : plane) sample = uniform(random);
    const double mean = std::accumulate(plane.begin(), plane.end(), 0.0);
    for (const double sigma_px : {0.3, 4.0, 50.0, 400.0}) {
        const std::vector<float> smooth = gaussian_blur(plane, 31, sigma_px);
        EXPECT_NEAR(std::accumulate(smooth.begin(), smooth.end(), 0.0), mean, mean * kFloat);
    }
}

// A point becomes the bell of that variance, the same each way, within the stated bound.
TEST(GaussianBlur, SpreadsAPointToTheGaussian) {
    constexpr int kSide = 201;
    constexpr int kMiddle = 100;
    constexpr double kBound = 0.035;  // of the peak along one axis, as the header says
    constexpr double kOfTwo = 2.0 * kBound + kBound * kBound;
    for (const double sigma_px : {2.0, 7.3, 15.0}) {
        std::vector<float> plane(kSide * kSide, 0.0F);
        plane[kMiddle * kSide + kMiddle] = 1.0F;
        const std::vector<float> bell = gaussian_blur(plane, kSide, sigma_px);
        const double peak = 1.0 / (2.0 * std::numbers::pi * sigma_px * sigma_px);
        double variance_x = 0.0;
        double variance_y = 0.0;
        for (int row = 0; row < kSide; ++row) {
            for (int column = 0; column < kSide; ++column) {
                const double x = column - kMiddle;
                const double y = row - kMiddle;
                const double found = bell[static_cast<std::size_t>(row * kSide + column)];
                const double wanted =
                    peak * std::exp(-(x * x + y * y) / (2.0 * sigma_px * sigma_px));
                ASSERT_NEAR(found, wanted, kOfTwo * peak) << x << ", " << y;
                variance_x += found * x * x;
                variance_y += found * y * y;
            }
        }
        EXPECT_NEAR(variance_x / (sigma_px * sigma_px), 1.0, 1e-4) << "floats far out add up";
        EXPECT_NEAR(variance_y / (sigma_px * sigma_px), 1.0, 1e-4);
    }
}

}  // namespace
}  // namespace aphotic::gaussian_blur_test
