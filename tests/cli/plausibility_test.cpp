// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs whose numbers are in another unit, as every command that reads a rig tells of them.
#include "support/command_test.h"
#include "support/has.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace aphotic::plausibility_command_test {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;

std::string with(const std::string& key, const std::string& value, const std::string& text) {
    return std::regex_replace(
        text, std::regex("\n" + key + "\\s*=[^\n#]*"), "\n" + key + " = " + value);
}

class CommandPlausibility : public CommandTest {
  protected:
    void SetUp() override {
        std::string text =
            read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/one-lamp.toml");
        text = with("pixel_pitch_um", "439.0", with("resolution", "[20, 15]", text));
        write_file(path("right.toml"), text);
        write_file(path("high.toml"), with("altitude_m", "2000", text));
        write_file(path("up.toml"), with("direction", "[0, 0, -1]", text));
    }
};

TEST_F(CommandPlausibility, EveryCommandWarnsAndStrictRefusesBeforeItWrites) {
    fs::create_directory(path("raw"));
    write_file(path("raw/a.tif"), "no image");
    write_file(path("nav.csv"), "image,altitude_m\na.tif,2\n");
    const std::vector<Arguments> commands{
        "plan RIG",
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
        "baseline homomorphic raw --rig RIG -o out"};
    for (const Arguments& command : commands) {
        Arguments strict = command;
        for (std::string& word : strict) {
            if (word == "RIG") word = "high.toml";
        }
        strict.emplace_back("--strict");
        const CommandResult result = aphotic(strict);
        EXPECT_EQ(result.status, kBadInput) << command[0] << "\n" << result.err;
        EXPECT_TRUE(has(result.err, "aphotic: --strict: looks wrong: high.toml:"))
            << command[0] << "\n";
        EXPECT_TRUE(has(result.err, "sled.altitude_m: found 2000; usual: 0.05 to 30"))
            << command[0] << "\n";
        EXPECT_FALSE(fs::exists(path("out"))) << command[0];
        EXPECT_FALSE(fs::exists(path("out.exr"))) << command[0];
    }
}

TEST_F(CommandPlausibility, ABlackMapIsToldOfAndWritten) {
    const CommandResult result = aphotic("lightmap up.toml -o map.exr");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(has(result.err,
                    "aphotic: looks wrong: up.toml: strobe[0]: 'lamp' is aimed 90 "
                    "degrees above the horizon, and lights nothing"));
    EXPECT_TRUE(has(result.err, "images are black"));
    EXPECT_TRUE(fs::exists(path("map.exr")));
}

TEST_F(CommandPlausibility, WhatAnOptionSetsIsJudged) {
    const CommandResult right = aphotic("lightmap right.toml -o map.exr --strict");
    EXPECT_EQ(right.status, 0) << right.err;
    const CommandResult high = aphotic("lightmap right.toml -o map.exr --altitude 2000");
    EXPECT_TRUE(has(high.err, "2 if that is in millimetres"));
}

}  // namespace
}  // namespace aphotic::plausibility_command_test
