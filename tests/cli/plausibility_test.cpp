// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs whose numbers are in another unit, as every command that reads a rig tells of them.
#include "support/command_test.h"
#include "support/has.h"
#include "support/scene_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::plausibility_command_test {
namespace {

namespace fs = std::filesystem;

class CommandPlausibility : public CommandTest {
  protected:
    void SetUp() override {
        const std::string text = with(scene_text("one-lamp.toml"),
                                      {{"resolution", "[20, 15]"}, {"pixel_pitch_um", "439.0"}});
        write_file(path("right.toml"), text);
        write_file(path("high.toml"), with(text, {{"altitude_m", "2000"}}));
        write_file(path("up.toml"), with(text, {{"direction", "[0, 0, -1]"}}));
    }
};

TEST_F(CommandPlausibility, EveryCommandWarnsAndStrictRefusesBeforeItWrites) {
    fs::create_directory(path("raw"));
    write_file(path("raw/a.tif"), "no image");
    write_file(path("nav.csv"), "image,altitude_m\na.tif,2\n");
    for (Arguments command :
         std::vector<Arguments>{"plan RIG",
                                "generate RIG -o out",
                                "generate RIG --quick-look out",
                                "render RIG -o out",
                                "trace RIG -o out",
                                "validate RIG -o out",
                                "study RIG -o out",
                                "lightmap RIG -o out.exr",
                                "lightmap RIG -o out --altitude 2:3:0.5",
                                "design RIG -o out --vary strobe.lamp.power",
                                "survey RIG -o out",
                                "correct raw --rig RIG --nav nav.csv -o out",
                                "observe raw --rig RIG --nav nav.csv --altitude 2 -o out.exr",
                                "fit RIG --images raw --nav nav.csv -o out",
                                "baseline homomorphic raw --rig RIG -o out"}) {
        std::ranges::replace(command, "RIG", "high.toml");
        EXPECT_TRUE(
            has(refused(command + "--strict", "aphotic: --strict: looks wrong: high.toml:").err,
                "sled.altitude_m: found 2000; usual: 0.05 to 30"));
    }
}

TEST_F(CommandPlausibility, ABlackMapIsToldOfAndWritten) {
    const CommandResult result = done("lightmap up.toml -o map.exr");
    EXPECT_TRUE(has(result.err,
                    "aphotic: looks wrong: up.toml: strobe[0]: 'lamp' is aimed 90 "
                    "degrees above the horizon, and lights nothing"));
    EXPECT_TRUE(has(result.err, "images are black"));
    EXPECT_TRUE(fs::exists(path("map.exr")));
}

TEST_F(CommandPlausibility, WhatAnOptionSetsIsJudged) {
    done("lightmap right.toml -o map.exr --strict");
    const CommandResult high = aphotic("lightmap right.toml -o map.exr --altitude 2000");
    EXPECT_TRUE(has(high.err, "2 if that is in millimetres"));
}

}  // namespace
}  // namespace aphotic::plausibility_command_test
