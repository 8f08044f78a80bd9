// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic init: a rig to change, and what `plan` says of its guesses.
#include "support/command_test.h"
#include "support/scene_text.h"

namespace aphotic::init_test {
namespace {

using Init = CommandTest;

TEST_F(Init, WritesARigWithAllThatItNames) {
    for (const std::string name : {"habcam", "led", "auv"}) {
        std::filesystem::create_directory(path(name));
        done({"init", name + "/my-rig.toml", "--like", name}, "aphotic plan " + name);
        done({"plan", name + "/my-rig.toml"}, "Still guesses of the template");
    }
}

TEST_F(Init, PlanListsWhatIsNotMeasured) {
    done("init my-rig.toml", "my-rig.toml\n20 lines are guesses");
    EXPECT_EQ(json_by("init same.toml --json"),
              nlohmann::json::parse(R"({"files": ["same.toml"], "guesses": 20})"));
    const auto lines = json_by("plan my-rig.toml --json").at("unmeasured");
    EXPECT_EQ(lines.size(), 20U);
    EXPECT_EQ(json_by("plan my-rig.toml --json").at("rig_title"), "my-rig");
    EXPECT_EQ(lines.at(1).at("text"), "pixel_pitch_um  = 6.45");
    write_file(path("my-rig.toml"), replaced(text_of("my-rig.toml"), "  # measure:", "  #"));
    EXPECT_FALSE(has(done("plan my-rig.toml").out, "Still guesses"));
}

TEST_F(Init, TakesNoFilesPlace) {
    write_file(path("auv-lamp.ies"), "another lamp");
    refused("init my-rig.toml --like auv", "auv-lamp.ies: exists; allowed: a new file");
    write_file(path("mine.toml"), "title = 'mine'");
    refused("init mine.toml", "mine.toml: exists; allowed: a new file");
    refused("init other.toml --like rov", "rov");
}

}  // namespace
}  // namespace aphotic::init_test
