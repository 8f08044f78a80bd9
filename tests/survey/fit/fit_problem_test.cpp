// SPDX-License-Identifier: BSD-3-Clause
//
// The numbers of the water that may be asked for are those that this water has.
#include "survey/fit/fit_problem.h"

#include "base/error.h"
#include "support/fit_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace aphotic::fit_problem_test {
namespace {

std::vector<std::string> keys_of(const std::string& word) {
    FitOptions options;
    options.free = {{word}};
    std::vector<std::string> keys;
    for (const FreeNumber& one : fit_problem(fit_rig({}), options, {.widest_rad = 1.0}).free)
        if (one.group == "water") keys.push_back(one.key);
    return keys;
}

TEST(FitProblem, TakesTheNumbersThatTheWaterHas) {
    EXPECT_EQ(keys_of("water.multiple"), std::vector<std::string>{"water.multiple"});
    EXPECT_EQ(keys_of("water.uniform_loss_per_m"),
              std::vector<std::string>{"water.uniform_loss_per_m"});
}

TEST(FitProblem, RefusesANumberThatTheWaterHasNot) {
    for (const char* word : {"water.nonsense", "water.chlorophyll_mg_m3"}) {
        try {
            static_cast<void>(keys_of(word));
            ADD_FAILURE() << "accepted: " << word;
        } catch (const InputError& error) {
            EXPECT_EQ(error.what(),
                      std::string("--free: found '") + word +
                          "'; allowed of this water: water.multiple, water.uniform_loss_per_m");
        }
    }
}

// Of vignetting or aims one number may be told where the others are not.
TEST(FitProblem, TakesNumbersByTheirKeys) {
    FitOptions options;
    const auto keys = [&](const std::vector<std::string>& asked) {
        options.free = asked;
        std::vector<std::string> found;
        for (const FreeNumber& one : fit_problem(fit_rig({}), options, {.widest_rad = 1.0}).free)
            if (one.group != kFloorColour) found.push_back(one.key);
        return found;
    };
    const std::vector<std::string> two{"strobe.aft.aim_across_deg", "camera.vignetting.a1"};
    EXPECT_EQ(keys(two), two);
    EXPECT_EQ(keys({"camera.vignetting.a2", "vignetting"}).size(), 3U);
    EXPECT_EQ(keys({"gain.R"}).front(), "gain.R");
    try {
        keys({"strobe.stern.aim_along_deg"});
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "--free: found 'strobe.stern.aim_along_deg'; allowed: "
                     "strobe.fore.aim_along_deg, strobe.fore.aim_across_deg, "
                     "strobe.aft.aim_along_deg, strobe.aft.aim_across_deg");
    }
    // The first strobe's power is what the others' are relative to.
    EXPECT_THROW(keys({"strobe.fore.power"}), InputError);
}

TEST(FitProblem, ABeamOfItsOwnHasItsOwnPower) {
    FitOptions options;
    options.free = {{"beam"}};
    const auto is_power_fixed = [&] {
        const FitProblem problem = fit_problem(fit_rig({}), options, {.widest_rad = 1.0});
        return std::ranges::count(words_fixed_in(problem), "power") > 0;
    };
    EXPECT_TRUE(is_power_fixed());
    options.has_beam_each = true;
    EXPECT_FALSE(is_power_fixed());
}

TEST(FitProblem, TellsALensInTheRigsUnits) {
    const RigText rig{std::filesystem::path(APHOTIC_SOURCE_DIR "/scenes/habcam-optics.toml")};
    const Strobe first = rig.rig().strobes[0];
    FitOptions options;
    options.beam = FitBeamKind::Optics;
    options.free = {{"beam"}};
    const FitProblem problem = fit_problem(rig, options, {.widest_rad = 1.0});
    const FreeNumber& focal_length = problem.free.front();
    EXPECT_EQ(focal_length.key, "strobe." + first.name + ".beam.focal_length_mm");
    EXPECT_DOUBLE_EQ(focal_length.per_unit * focal_length.start,
                     1e3 * std::get<BeamOptics>(first.beam.pattern).focal_length_m);
}

TEST(FitProblem, NamesWhatIsAsTheRigHasIt) {
    FitOptions options;
    options.free = {{"aim", "water.multiple", "altitude"}};
    const FitAngles angles{.widest_rad = 1.0};
    EXPECT_EQ(
        words_fixed_in(fit_problem(fit_rig({}), options, angles)),
        (std::vector<std::string>{"beam", "power", "vignetting", "floor", "attitude", "gain"}));
    options.free.reset();
    EXPECT_EQ(words_fixed_in(fit_problem(fit_rig({}), options, angles)),
              (std::vector<std::string>{"floor", "altitude", "attitude", "gain"}));
}

// The first strobe of a beam that shines has the power that the others are told by.
TEST(FitProblem, AStrobeThatIsOffIsNoReference) {
    FitOptions options;
    options.free = {{"power"}};
    const auto powers = [&](const char* off) {
        RigText rig = fit_rig({});
        if (*off != '\0') rig.set(fmt::format("strobe.{}.power", off), 0.0);
        std::vector<std::string> keys;
        for (const FreeNumber& one : fit_problem(rig, options, {.widest_rad = 1.0}).free)
            if (one.group == "power") keys.push_back(one.key);
        return keys;
    };
    EXPECT_EQ(powers(""), std::vector<std::string>{"strobe.aft.power"});
    EXPECT_EQ(powers("fore"), std::vector<std::string>{});
    EXPECT_EQ(powers("aft"), std::vector<std::string>{});
}

}  // namespace
}  // namespace aphotic::fit_problem_test
