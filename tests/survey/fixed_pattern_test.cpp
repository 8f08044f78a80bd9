// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fixed_pattern.h"

#include "support/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace aphotic::fixed_pattern_test {
namespace {

constexpr std::size_t kAcross = 16;
constexpr std::size_t kDown = 12;
constexpr std::size_t kPlaces = kAcross * kDown;
constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

// Floors with long waves in random directions, as rough fields have them, grains, and one pale
// patch in each: what chance leaves is correlated, and differences have heavy tails.
std::vector<std::vector<float>> floors(std::size_t images, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<std::vector<float>> residuals;
    for (std::size_t i = 0; i < images; ++i) {
        const double x = 0.05 * normal(random);
        const double y = 0.05 * normal(random);
        const std::size_t patch = random() % (kPlaces - 3);
        std::vector<float> residual;
        for (std::size_t k = 0; k < kPlaces; ++k) {
            const double slope = x * static_cast<double>(k % kAcross) / kAcross +
                                 y * static_cast<double>(k / kAcross) / kDown;
            const double pale = k >= patch && k < patch + 3 ? 1.0 : 0.0;
            residual.push_back(static_cast<float>(slope + pale + 0.03 * normal(random)));
        }
        residuals.push_back(std::move(residual));
    }
    return residuals;
}

template <typename Pattern>
void add(const Pattern& pattern, std::vector<std::vector<float>>& residuals) {
    for (std::vector<float>& residual : residuals)
        for (std::size_t k = 0; k < residual.size(); ++k)
            residual[k] += static_cast<float>(pattern(k));
}

double chequered(std::size_t k) {
    constexpr double kAmplitude = 0.05;
    return (k / kAcross + k) % 2 == 0 ? kAmplitude : -kAmplitude;
}

// The level of the test is 1 in kDraws + 1, so of 200 surveys about one exceeds chance; more than 5
// would with a probability of 6e-4 (Poisson).
TEST(FixedPattern, OfFloorsAloneExceedsChanceAsRarelyAsItsLevel) {
    constexpr int kAll = 200;
    constexpr int kMost = 5;
    constexpr int kSurveys = cases(kAll);
    int exceed = 0;
    double squares = 0.0;
    double by_chance = 0.0;
    for (unsigned seed = 0; seed < kSurveys; ++seed) {
        const FixedPattern found = fixed_pattern(floors(16, seed), kAcross);
        exceed += found.exceeds_chance() ? 1 : 0;
        squares += found.rms * found.rms;
        by_chance += found.by_chance * found.by_chance;
    }
    if (kSurveys < kAll) GTEST_SKIP() << "too few to tell";
    EXPECT_LE(exceed, kMost);
    // What is said to be chance's part is that on average: a standard error of some 5 % each.
    EXPECT_NEAR(squares / by_chance, 1.0, 0.25);
}

TEST(FixedPattern, IsTheOneThatIsThere) {
    auto residuals = floors(24, 1);
    add(chequered, residuals);
    const FixedPattern found = fixed_pattern(residuals, kAcross);
    EXPECT_TRUE(found.is_too_large());
    EXPECT_NEAR(found.excess(), 0.05, 0.1 * 0.05);
    for (std::size_t k = 0; k < kPlaces; ++k)
        EXPECT_NEAR(found.logarithm[k], chequered(k), 5.0 * found.by_chance) << k;
}

// An image's level is its floor's, whatever pattern it has.
TEST(FixedPattern, DoesNotDependOnLevels) {
    auto residuals = floors(16, 2);
    const FixedPattern before = fixed_pattern(residuals, kAcross);
    for (std::size_t i = 0; i < residuals.size(); ++i)
        for (float& r : residuals[i]) r += 0.25F * static_cast<float>(i);
    EXPECT_NEAR(fixed_pattern(residuals, kAcross).rms, before.rms, 1e-5);
}

TEST(FixedPattern, IsUnknownWhereNothingIsSeen) {
    auto residuals = floors(16, 3);
    for (std::vector<float>& residual : residuals) residual[0] = residual[kAcross + 2] = kUnseen;
    const FixedPattern found = fixed_pattern(residuals, kAcross);
    EXPECT_TRUE(std::isnan(found.logarithm[0]));
    EXPECT_TRUE(std::isnan(found.logarithm[kAcross + 2]));
    EXPECT_FALSE(std::isnan(found.logarithm[1]));
    EXPECT_TRUE(std::isfinite(found.rms));
}

// With so few, the draws include the images as they are.
TEST(FixedPattern, OfFewImagesCannotExceedChance) {
    auto residuals = floors(4, 4);
    add(chequered, residuals);
    EXPECT_FALSE(fixed_pattern(residuals, kAcross).exceeds_chance());
    EXPECT_FALSE(fixed_pattern({}, kAcross).exceeds_chance());
}

TEST(FixedPattern, InWords) {
    FixedPattern pattern{.images = 16, .by_chance = 0.012, .most_by_chance = 0.02};
    EXPECT_EQ(words_of(pattern), "");
    pattern.logarithm = {0.0F};
    pattern.rms = 0.019;
    EXPECT_EQ(
        words_of(pattern),
        "a fixed pattern of 1.9 % over 16 images, no more than chance: floors alone leave 1.2 %");
    pattern.rms = 0.084;
    EXPECT_EQ(words_of(pattern),
              "a fixed pattern of 8.4 % over 16 images, where floors alone leave 1.2 %");
}

}  // namespace
}  // namespace aphotic::fixed_pattern_test
