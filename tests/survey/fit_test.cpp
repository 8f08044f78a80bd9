// SPDX-License-Identifier: BSD-3-Clause
//
// Fits to light whose rig is known.
#include "survey/fit.h"

#include "base/degrees.h"
#include "base/error.h"
#include "support/fit_rig.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::fit_test {
namespace {

constexpr double kNoise = 0.01;

std::vector<Sled> flown(std::initializer_list<double> altitudes_m) {
    std::vector<Sled> sleds;
    double tilt_deg = -3.0;
    for (const double altitude_m : altitudes_m) {
        sleds.push_back({.altitude_m = altitude_m,
                         .pitch_rad = tilt_deg * kRadiansPerDegree,
                         .roll_rad = -0.7 * tilt_deg * kRadiansPerDegree});
        tilt_deg = -tilt_deg + 0.8;
    }
    return sleds;
}

// What the search begins with: an aim, a power, a water and a lens that are none of the truth's.
RigText guess() {
    FitRigNumbers numbers;
    numbers.fore_tilt_deg = 24.0;
    numbers.aft_power = 1.0;
    numbers.multiple = 1.4;
    numbers.exponent = 2.0;
    numbers.a1 = 0.0;
    return fit_rig(numbers);
}

FitOptions exact_poses() {
    FitOptions options;
    options.altitude_error_m = 0.0;
    options.attitude_error_rad = 0.0;
    options.threads = 2;
    return options;
}

double value_of(const FitResult& result, const std::string& key) {
    const auto at = std::ranges::find(result.numbers, key, &FittedNumber::key);
    EXPECT_NE(at, result.numbers.end()) << key;
    return at == result.numbers.end() ? 0.0 : at->value;
}

TEST(Fit, FindsTheRigThatMadeTheMaps) {
    const Rig truth = fit_rig({}).rig();
    const std::vector<Sled> sleds = flown({1.2, 1.5, 2.0, 2.5, 3.2});
    const FitSamples samples = fit_samples_of(truth, sleds, kNoise, 1);
    const FitResult result = fit(guess(), samples, exact_poses(), {});
    for (const FittedNumber& one : result.numbers) {
        fmt::print("{} {} -> {} +- {}\n", one.key, one.start, one.value, one.error);
    }
    for (const NotTold& one : result.held) fmt::print("held {}\n", words_of(one));
    fmt::print("steps {} residual {} pattern {} noise {}\n",
               result.steps,
               result.residual,
               result.pattern,
               result.noise.variance[2]);
    EXPECT_NEAR(value_of(result, "water.multiple"), 1.0, 0.02);
}

}  // namespace
}  // namespace aphotic::fit_test
