// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_check.h"

#include <gtest/gtest.h>

#include <cmath>
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
        result.pattern = {.rms = 0.01, .by_chance = 0.01, .most_by_chance = 0.015};
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
    FixedPattern& pattern = fitted.result.pattern;
    const auto rms_of = [&](double excess) { return std::hypot(excess, pattern.by_chance); };
    pattern.rms = rms_of(kMore * kMostPattern);
    EXPECT_EQ(fitted.signs(), "pattern\n");
    pattern.most_by_chance = kMore * pattern.rms;
    EXPECT_EQ(fitted.signs(), "");
    pattern.most_by_chance = pattern.by_chance;
    pattern.rms = rms_of(kLess * kMostPattern);
    EXPECT_EQ(fitted.signs(), "");
}

TEST(FitCheck, NumbersThatAreFarFromTheRigs) {
    Fitted fitted;
    FittedNumber& multiple = fitted.result.numbers.front();
    multiple.value = 1.0 - kLess * kFarthest * multiple.spread;
    EXPECT_EQ(fitted.signs(), "");
    multiple.value = 1.0 - kMore * kFarthest * multiple.spread;
    EXPECT_EQ(fitted.signs(), "range\n");
    // Of a logarithm, as far down is as likely as as far up.
    multiple.is_log = true;
    for (const double way : {-1.0, 1.0}) {
        multiple.value = std::exp(way * kLess * kFarthest * multiple.spread);
        EXPECT_EQ(fitted.signs(), "");
        multiple.value = std::exp(way * kMore * kFarthest * multiple.spread);
        EXPECT_EQ(fitted.signs(), "range\n");
    }
}

TEST(FittedNumber, HasTheDigitsThatItsErrorEarns) {
    EXPECT_EQ(with_error({.value = 4.0624, .error = 0.1329}), "4.06 +- 0.13");
    EXPECT_EQ(with_error({.value = 12355.4, .error = 271.0}), "12355 +- 271");
    EXPECT_EQ(with_error({.value = 0.0, .error = 0.0094}), "0.0000 +- 0.0094");
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
