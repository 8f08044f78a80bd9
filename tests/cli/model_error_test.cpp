// SPDX-License-Identifier: BSD-3-Clause
//
// The model error estimate, as the commands tell it.
#include "base/atomic_file.h"
#include "image/exr.h"
#include "support/command_test.h"
#include "support/has.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>
#include <string>
#include <vector>

namespace aphotic::model_error_test {
namespace {

constexpr int kBadInput = 2;

class CommandModelError : public CommandTest {
  protected:
    void SetUp() override {
        std::string text =
            read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam-led.toml");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*resolution\s*=[^\n]*)"), "\nresolution = [24, 15]");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*pixel_pitch_um\s*=[^\n]*)"), "\npixel_pitch_um = 470.0");
        // The range of Jerlov's types.
        clear_ = std::regex_replace(
            text, std::regex(R"(\n\s*range_nm\s*=[^\n]*)"), "\nrange_nm = [400, 700]");
        water_is(R"(type = "jerlov-1C")");
    }

    void water_is(const std::string& keys) const {
        write_file(path("rig.toml"),
                   std::regex_replace(
                       clear_, std::regex(R"(\nabsorption = "pope-fry-1997")"), "\n" + keys));
    }

    std::string clear_;
};

TEST_F(CommandModelError, IsToldBesideThePromiseAndNotedInTheMap) {
    const CommandResult plan = aphotic("plan rig.toml --json");
    ASSERT_EQ(plan.status, 0) << plan.err;
    const auto json = nlohmann::json::parse(plan.out);
    const CommandResult map = aphotic("lightmap rig.toml -o map.exr");
    ASSERT_EQ(map.status, 0) << map.err;
    EXPECT_TRUE(has(map.out, "what the model of scattering leaves out is estimated at 0.0"));
    const std::string noted = ExrReader(path("map.exr")).attribute("aphotic:model_error");
    double red = 0.0;
    double green = 0.0;
    double blue = 0.0;
    std::istringstream(noted) >> red >> green >> blue;
    EXPECT_EQ(json["model_error"]["R"], red);  // the same seed
    EXPECT_EQ(json["model_error"]["G"], green);
    EXPECT_EQ(json["model_error"]["B"], blue);
    EXPECT_GT(red, 0.0);
}

TEST_F(CommandModelError, IsRefusedOverTheTolerance) {
    for (const Arguments& command :
         std::vector<Arguments>{"plan rig.toml",
                                "trace rig.toml -o out",
                                "lightmap rig.toml -o map.exr",
                                "lightmap rig.toml -o out --altitude 1:2:1"}) {
        const CommandResult refused = aphotic(command + "--model-tolerance 1e-9");
        EXPECT_EQ(refused.status, kBadInput) << command.front();
        EXPECT_TRUE(has(refused.err,
                        "in what the model of water that scatters leaves out: light "
                        "that is turned more than once, and blur; allowed: "
                        "--model-tolerance 1e-09"));
        EXPECT_FALSE(std::filesystem::exists(path("out"))) << command.front();
        EXPECT_FALSE(std::filesystem::exists(path("map.exr"))) << command.front();
    }
}

TEST_F(CommandModelError, IsOfEachMapByAltitude) {
    const auto json_of = [&](const Arguments& options) {
        const CommandResult made = aphotic("lightmap rig.toml --json" + options);
        EXPECT_EQ(made.status, 0) << made.err;
        return nlohmann::json::parse(made.out);
    };
    const auto maps = json_of("-o out --altitude 1,3")["maps"];
    ASSERT_EQ(maps.size(), 2U);
    EXPECT_EQ(maps[1]["model_error"], json_of("-o map.exr --altitude 3")["model_error"]);
    EXPECT_NE(maps[0]["model_error"], maps[1]["model_error"]);
}

TEST_F(CommandModelError, IsNoneOfWaterThatDoesNotScatterNorWithoutItsVeil) {
    EXPECT_EQ(aphotic("lightmap rig.toml -o map.exr --no-veil").out.find("leaves out"),
              std::string::npos);
    water_is(R"(absorption = "pope-fry-1997")");
    const CommandResult plan = aphotic("plan rig.toml --json --model-tolerance 1e-9");
    ASSERT_EQ(plan.status, 0) << plan.err;
    EXPECT_FALSE(nlohmann::json::parse(plan.out).contains("model_error"));
}

}  // namespace
}  // namespace aphotic::model_error_test
