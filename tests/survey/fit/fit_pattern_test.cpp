// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_pattern.h"

#include "support/fit_rig.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::fit_pattern_test {
namespace {

constexpr double kNoise = 0.02;

std::vector<Sled> flown() {
    std::vector<Sled> sleds;
    for (int i = 0; i < 24; ++i) sleds.push_back({.altitude_m = 1.5 + 0.05 * i});
    return sleds;
}

// Of maps of the rig with noise, times a pattern that is the same in all.
template <typename Pattern>
FitPattern pattern_with(const Pattern& pattern) {
    const RigText text = fit_rig({.width_px = 16, .height_px = 12});
    FitSamples samples = fit_samples_of(text.rig(), flown(), kNoise, 3);
    for (FitImage& image : samples.images)
        for (std::size_t i = 0; i < image.signal.size(); ++i)
            image.signal[i] *= static_cast<float>(std::exp(pattern(i / kChannels)));
    const FitOptions options{.altitude_error_m = 0.0, .attitude_error_rad = 0.0};
    const FitLight light(text.rig(), samples.places);
    const FitProblem problem = fit_problem(text, options, 1.0, light.block_rad());
    const FitObjective objective(text, samples, options, light, problem);
    return pattern_of(objective, objective.first_point(), samples.places);
}

TEST(FitPattern, OfNoiseIsChance) {
    const FitPattern found = pattern_with([](std::size_t) { return 0.0; });
    EXPECT_NEAR(found.whitened, 1.0, 4.0 * found.chance);
    EXPECT_LT(found.rms, 1.5 * found.by_chance);
    EXPECT_GT(found.rms, 0.5 * found.by_chance);
}

TEST(FitPattern, IsTheOneThatIsThere) {
    constexpr double kAmplitude = 0.05;
    const auto chequered = [](std::size_t place) {
        return (place / 16 + place) % 2 == 0 ? kAmplitude : -kAmplitude;
    };
    const FitPattern found = pattern_with(chequered);
    EXPECT_GT(found.whitened, 1.0 + 20.0 * found.chance);
    EXPECT_NEAR(found.rms, kAmplitude, 0.1 * kAmplitude);
    const double most = 5.0 * found.by_chance;
    for (std::size_t place = 0; place < found.logarithm.size(); ++place)
        EXPECT_NEAR(found.logarithm[place], chequered(place), most) << place;
}

}  // namespace
}  // namespace aphotic::fit_pattern_test
