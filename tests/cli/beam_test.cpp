// SPDX-License-Identifier: BSD-3-Clause
#include "support/command_test.h"
#include "support/has.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

namespace aphotic::beam_command_test {
namespace {

const std::string kLed = std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam-led.toml:led";

class CommandBeam : public CommandTest {
  protected:
    static Arguments beam(const Arguments& arguments) { return "beam" + arguments; }
    nlohmann::json json(Arguments arguments) {
        arguments += "--json";
        return json_by(beam(std::move(arguments)));
    }
};

// cos^n with n = ln 0.5 / ln cos 50: (n + 1) / (2 pi) on the axis, times the lamp's lumens in
// candela.
TEST_F(CommandBeam, SaysWhatADataSheetDoes) {
    const double n = std::log(0.5) / std::log(std::cos(50.0 / 180.0 * std::numbers::pi));
    const double on_axis = (n + 1.0) / (2.0 * std::numbers::pi);
    const nlohmann::json led = json({kLed});
    EXPECT_NEAR(led["flux"].get<double>(), 1.0, 1e-9);
    EXPECT_NEAR(led["largest_per_sr"].get<double>(), on_axis, 1e-9);
    EXPECT_NEAR(led["fwhm_along_deg"].get<double>(), 100.0, 1e-4);
    EXPECT_NEAR(led["fwhm_across_deg"].get<double>(), 100.0, 1e-4);
    ASSERT_EQ(led["lamps"].size(), 4U);
    EXPECT_NEAR(led["lamps"][0]["luminous_flux_lm"].get<double>(), 30000.0, 1e-6);
    EXPECT_NEAR(led["lamps"][0]["largest_cd"].get<double>() / (30000.0 * on_axis), 1.0, 1e-9);
    EXPECT_TRUE(has(aphotic(beam({kLed})).out, "100.00 degrees along, 100.00 across"));
}

// Linear between nodes of a degree, cos^n errs most in the last, where it bends towards 0.
TEST_F(CommandBeam, HandsABeamOnAndReadsItBack) {
    const double n = std::log(0.5) / std::log(std::cos(50.0 / 180.0 * std::numbers::pi));
    const auto before_end = [&](double degrees) {
        return std::pow(std::sin(degrees / 180.0 * std::numbers::pi), n);
    };
    const double bend = 0.5 * before_end(1.0) - before_end(0.5);
    for (const std::string name : {"led.ies", "led.ldt", "led.csv"}) {
        const nlohmann::json made = json({kLed, "--export", name});
        EXPECT_NEAR(made["export_error"].get<double>() / bend, 1.0, 1e-6) << name;
        const nlohmann::json read = json({name});
        EXPECT_NEAR(read["fwhm_along_deg"].get<double>(), 100.0, 0.02) << name;
        EXPECT_NEAR(
            read["largest_per_sr"].get<double>() / made["largest_per_sr"].get<double>(), 1.0, 1e-4);
        if (name == "led.csv") continue;
        EXPECT_NEAR(read["lamps"][0]["luminous_flux_lm"].get<double>(), 30000.0, 3.0) << name;
    }
}

TEST_F(CommandBeam, FindsTheClosestCones) {
    const nlohmann::json one = json({kLed, "--fit-cones", "1"});
    const nlohmann::json four = json({kLed, "--fit-cones", "4"});
    EXPECT_EQ(four["cones"].size(), 4U);
    EXPECT_LT(four["cones_error"].get<double>(), one["cones_error"].get<double>());
    // Printed so that a rig can take them.
    EXPECT_TRUE(
        has(aphotic(beam({kLed, "--fit-cones", "2"})).out, "cones = [\n  { part = \"cone1\""));
}

TEST_F(CommandBeam, Plots) {
    done(beam({kLed, "--plot", "led.svg"}));
    const std::string svg = text_of("led.svg");
    EXPECT_TRUE(has(svg, "angle off the axis"));
    EXPECT_TRUE(has(svg, "as thrown"));
}

TEST_F(CommandBeam, NamesWhatThereIs) {
    const std::string rig = std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam-led.toml";
    refused(beam({rig + ":flash"}), "found no strobe with the beam 'flash'; allowed: led");
    refused(beam({rig}), "allowed: RIG:NAME, a beam of a rig, or a .ies, .ldt or .csv file");
    EXPECT_EQ(aphotic(beam({"missing.ies"})).status, 2);
}

}  // namespace
}  // namespace aphotic::beam_command_test
