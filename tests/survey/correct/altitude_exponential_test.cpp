// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/altitude_exponential.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::altitude_exponential_test {
namespace {

constexpr double kBin_m = 0.1;
constexpr double kSearch = 2e-3;  // the search for b ends at 16 bits
constexpr double kDeviation = 0.2;

const std::vector<double> kAltitudes_m{1.0, 1.33, 1.6, 2.2, 2.87};

// a exp(b h) + c of three pixels, the last of no light.
std::vector<float> light_at(double altitude_m, double floor) {
    return {static_cast<float>(floor * (4.0 * std::exp(-0.9 * altitude_m) + 0.3)),
            static_cast<float>(floor * 2.0 * std::exp(-0.4 * altitude_m)),
            0.0F};
}

AltitudeExponential learned() {
    AltitudeExponential exponential(3, kBin_m);
    for (const double h : kAltitudes_m)
        for (const double floor : {1.0 - kDeviation, 1.0 + kDeviation})
            exponential.learn_level(light_at(h, floor), h);
    exponential.fit(2);
    for (const double h : kAltitudes_m)
        for (const double floor : {1.0 - kDeviation, 1.0 + kDeviation})
            exponential.learn_spread(light_at(h, floor), h);
    exponential.end();
    return exponential;
}

// m = f(h0) and s = 0.2 f(h0), so that (J - m) S / s + M = (floor - 1) / 0.2 S + M, where M is the
// mean of m over the three pixels and S = 0.2 M.
TEST(AltitudeExponential, BringsAllToTheMeanAltitudeAndOneSpread) {
    const AltitudeExponential exponential = learned();
    const double mean_m = (1.0 + 1.33 + 1.6 + 2.2 + 2.87) / 5.0;
    const std::vector<float> level = light_at(mean_m, 1.0);
    const double common = (level[0] + level[1]) / 3.0;
    for (const double h : kAltitudes_m) {
        for (const double floor : {0.5, 1.0, 1.2}) {
            const std::vector<float> out = exponential.corrected(light_at(h, floor), h);
            EXPECT_NEAR(out[0], floor * common, kSearch) << h;
            EXPECT_NEAR(out[1], floor * common, kSearch) << h;
            EXPECT_NEAR(out[2], common, kSearch) << h;
        }
    }
}

// An image that is e times as bright moves by that as much as any other.
TEST(AltitudeExponential, FollowsTheScaleOfItsImages) {
    AltitudeExponential exponential(3, kBin_m);
    constexpr double kScale = 1000.0;
    for (const double h : kAltitudes_m) exponential.learn_level(light_at(h, kScale), h);
    exponential.fit(1);
    for (const double h : kAltitudes_m) exponential.learn_spread(light_at(h, kScale), h);
    exponential.end();
    const std::vector<float> level = light_at(1.8, kScale);
    const std::vector<float> out = exponential.corrected(level, 1.8);
    EXPECT_NEAR(out[0] / ((level[0] + level[1]) / 3.0), 1.0, kSearch);
}

TEST(AltitudeExponential, NeedsMoreAltitudesThanItHasParameters) {
    AltitudeExponential exponential(3, kBin_m);
    for (const double h : {1.0, 1.02, 2.0, 3.0}) exponential.learn_level(light_at(h, 1.0), h);
    EXPECT_THROW(exponential.fit(1), InputError);
}

}  // namespace
}  // namespace aphotic::altitude_exponential_test
