// SPDX-License-Identifier: BSD-3-Clause
//
// The model error estimate, as the commands tell it.
#include "image/exr.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/scene_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace aphotic::model_error_test {
namespace {

class CommandModelError : public CommandTest {
  protected:
    void SetUp() override {
        // The range of Jerlov's types.
        clear_ = with(
            scene_text("habcam-led.toml"),
            {{"resolution", "[24, 15]"}, {"pixel_pitch_um", "470.0"}, {"range_nm", "[400, 700]"}});
        water_is(R"(type = "jerlov-1C")");
    }

    void water_is(const std::string& keys) const {
        write_file(path("rig.toml"), replaced(clear_, R"(absorption = "pope-fry-1997")", keys));
    }

    std::string clear_;
};

TEST_F(CommandModelError, IsToldBesideThePromiseAndNotedInTheMap) {
    const auto json = json_by("plan rig.toml --json");
    done("lightmap rig.toml -o map.exr", "model error estimate, of scattering: 0.0");
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
    const std::vector<std::pair<Arguments, std::string>> commands{
        {"plan rig.toml", "sled.altitude_m"},
        {"trace rig.toml -o out", "sled.altitude_m"},
        {"lightmap rig.toml -o map.exr", "--altitude"},
        {"lightmap rig.toml -o out --altitude 1:2:1", "--altitude"},
        {"survey rig.toml -o dive", "--altitude"}};
    for (const auto& [command, altitude_by] : commands) {
        refused(command + "--model-tolerance 1e-9",
                "in what the model leaves out of water that scatters: light scattered more than "
                "once, and blur; allowed: --model-tolerance 1e-09. Lower altitudes (" +
                    altitude_by + ") and wider beams reduce it");
    }
}

TEST_F(CommandModelError, IsOfEachMapByAltitude) {
    const auto json_of = [&](const Arguments& options) {
        return json_by("lightmap rig.toml --json" + options);
    };
    const auto maps = json_of("-o out --altitude 1,3")["maps"];
    ASSERT_EQ(maps.size(), 2U);
    EXPECT_EQ(maps[1]["model_error"], json_of("-o map.exr --altitude 3")["model_error"]);
    EXPECT_NE(maps[0]["model_error"], maps[1]["model_error"]);
}

TEST_F(CommandModelError, IsNoneOfWaterThatDoesNotScatterNorWithoutItsVeil) {
    EXPECT_FALSE(has(done("lightmap rig.toml -o map.exr --no-veil").out, "leaves out"));
    water_is(R"(absorption = "pope-fry-1997")");
    EXPECT_FALSE(json_by("plan rig.toml --json --model-tolerance 1e-9").contains("model_error"));
}

}  // namespace
}  // namespace aphotic::model_error_test
