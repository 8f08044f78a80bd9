// SPDX-License-Identifier: BSD-3-Clause
//
// A beam without detail, and noise: few parts. One with an edge, and little noise: many.
#include "survey/fit/fit_parts.h"

#include "support/fit_rig.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace aphotic::fit_parts_test {
namespace {

// cos^6 off its axis is a bell without detail; an edge is finer than any of kRungs follows.
constexpr std::size_t kFew = 8;
constexpr std::size_t kMany = 24;
constexpr double kLoud = 0.1;
constexpr double kQuiet = 0.003;

FitRigNumbers small() {
    return {.width_px = 12, .height_px = 9};
}

std::vector<Sled> flown() {
    std::vector<Sled> sleds;
    for (int i = 0; i < 12; ++i) {
        sleds.push_back({.altitude_m = 1.3 + 0.1 * i,
                         .pitch_rad = 0.05 * std::sin(2.0 * i),
                         .roll_rad = 0.05 * std::cos(3.0 * i)});
    }
    return sleds;
}

// Half of the smooth beam's light within 20 degrees.
RigText edged_rig() {
    std::string text = fit_rig(small()).text();
    const std::size_t at = text.find("cones = [");
    text.replace(at,
                 text.find('\n', at) - at,
                 R"(cones = [{ part = "all", half_angle_deg = 90.0, weight = 0.5, exponent = 6.0 },
         { part = "edged", half_angle_deg = 20.0, weight = 0.5 }])");
    return {text, "edged.toml", {}};
}

std::size_t told_parts(const Rig& truth, double noise) {
    const RigText guess = fit_rig(small());
    const FitSamples samples = fit_samples_of(truth, flown(), noise, 1);
    const FitLight light(guess.rig(), samples.places);
    FitOptions options{.altitude_error_m = 0.0, .attitude_error_rad = 0.0, .threads = 2};
    options.free = {{"beam", "aim", "power", "vignetting"}};
    const FitAngles angles{.widest_rad = light.widest_rad(flown()), .block_rad = light.block_rad()};
    return with_told_parts(guess, samples, options, angles, {}).state.beams.at(0).parts();
}

// The host's level of glog, by which Ceres logs, is the host's.
TEST(FitParts, AreFewOfASmoothBeam) {
    auto* const level = static_cast<int*>(::dlsym(RTLD_DEFAULT, "_ZN3fLI17FLAGS_minloglevelE"));
    ASSERT_NE(level, nullptr) << "glog's FLAGS_minloglevel";
    const int before = *level;
    EXPECT_LE(told_parts(fit_rig(small()).rig(), kLoud), kFew);
    EXPECT_EQ(*level, before);
}

TEST(FitParts, AreManyOfABeamWithAnEdge) {
    EXPECT_GE(told_parts(edged_rig().rig(), kQuiet), kMany);
}

}  // namespace
}  // namespace aphotic::fit_parts_test
