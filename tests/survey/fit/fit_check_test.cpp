// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_check.h"

#include <gtest/gtest.h>

#include <string>

namespace aphotic::fit_check_test {
namespace {

constexpr double kLess = 0.98;
constexpr double kMore = 1.02;

// What a fit might leave of a survey: nothing to speak of.
struct Fitted {
    FitSamples samples;
    FitResult result;

    Fitted() {
        samples.images.resize(20);
        result.numbers = {
            {.key = "water.multiple", .start = 1.0, .value = 1.0, .error = 0.02, .spread = 0.3},
            {.key = "strobe.fore.beam.ln_0", .start = 0.0, .value = 9.0, .spread = 0.3}};
        result.pattern = {
            .logarithm = {}, .rms = 0.01, .by_chance = 0.01, .whitened = 1.0, .chance = 0.02};
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

// It must be large, and larger than chance.
TEST(FitCheck, ResidualsThatStayInPlace) {
    Fitted fitted;
    FitPattern& pattern = fitted.result.pattern;
    const double much = 1.0 + kMore * kPatternSigmas * pattern.chance;
    pattern.rms = kMore * kMostPattern;
    EXPECT_EQ(fitted.signs(), "");
    pattern.whitened = much;
    EXPECT_EQ(fitted.signs(), "pattern\n");
    pattern.rms = kLess * kMostPattern;
    EXPECT_EQ(fitted.signs(), "");
}

TEST(FitCheck, NumbersThatAreFarFromTheRigs) {
    Fitted fitted;
    FittedNumber& multiple = fitted.result.numbers.front();
    multiple.value = 1.0 - kLess * kFarthest * multiple.spread;
    EXPECT_EQ(fitted.signs(), "");
    multiple.value = 1.0 - kMore * kFarthest * multiple.spread;
    EXPECT_EQ(fitted.signs(), "range\n");
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
