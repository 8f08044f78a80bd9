// SPDX-License-Identifier: BSD-3-Clause
//
// Every scene of the project, small, through both renderers.
#include "support/run_command.h"
#include "support/small_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace aphotic {
namespace {

class EveryScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(EveryScene, Validates) {
    const TempFolder folder;
    put_small_scene(GetParam(), folder.path());
    const CommandResult run =
        run_aphotic(folder.path(),
                    {"validate", "rig.toml", "-o", "out", "--wavelengths", "410,470,550,620,700"});
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    const auto json =
        nlohmann::json::parse(read_text_file(folder.path() / "out" / "validation.json"));
    EXPECT_EQ(json.at("wavelengths").size(), 5U);
    EXPECT_EQ(json.at("channels").size(), 3U);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / "report.html"));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, EveryScene, testing::ValuesIn(all_scenes()), [](const auto& scene) {
        std::string name =
            scene.param.parent_path().filename().string() + "_" + scene.param.stem().string();
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
        return name;
    });

// Equal bands: their error is most of the promise, and nearly reached.
TEST(Validate, PromiseOfBandsHoldsAndIsNoMoreThanFiveTimesTheErrorFound) {
    const TempFolder folder;
    write_file(folder.path() / "rig.toml",
               small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"));
    const CommandResult run =
        run_aphotic(folder.path(), {"validate", "rig.toml", "-o", "out", "--bands", "9", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    for (const auto& channel : json.at("channels")) {
        const double promised = channel.at("bound").get<double>();
        const double found = channel.at("max_error").get<double>();
        EXPECT_GT(found, promised / 5.0) << channel.dump();
    }
}

TEST(Trace, LeavesImagesWithoutPovRayAndThreadsChangeNoBit) {
    const TempFolder folder;
    write_file(folder.path() / "rig.toml",
               small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/port.toml"));
    const std::map<std::string, std::string> no_povray{{"APHOTIC_POVRAY", "/no/povray"}};
    for (const std::string threads : {"1", "3"}) {
        const CommandResult run = run_aphotic(
            folder.path(),
            {"trace", "rig.toml", "-o", threads, "--threads", threads, "--wavelengths", "470,550"},
            no_povray);
        ASSERT_EQ(run.status, 0) << run.err;
    }
    for (const char* file : {"image.exr", "spectral.exr", "preview.png"}) {
        EXPECT_EQ(read_text_file(folder.path() / "1" / file),
                  read_text_file(folder.path() / "3" / file))
            << file;
    }
}

// `compare` reads any format: here a PNG against itself, and two EXRs that differ.
TEST(Compare, SaysYesAndNo) {
    const TempFolder folder;
    write_file(folder.path() / "rig.toml",
               small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"));
    ASSERT_EQ(run_aphotic(folder.path(), {"trace", "rig.toml", "-o", "a"}).status, 0);
    std::string brighter = read_text_file(folder.path() / "rig.toml");
    // One strobe of four brighter by a thousandth: up to 1e-3 in its cone, and nowhere more.
    brighter += "power = 1.001\n";
    write_file(folder.path() / "brighter.toml", brighter);
    ASSERT_EQ(run_aphotic(folder.path(), {"trace", "brighter.toml", "-o", "b"}).status, 0);

    EXPECT_EQ(run_aphotic(folder.path(), {"compare", "a/preview.png", "a/preview.png"}).status, 0);
    const CommandResult no = run_aphotic(
        folder.path(), {"compare", "b/image.exr", "a/image.exr", "--bound", "1e-4", "--json"});
    EXPECT_EQ(no.status, 1) << no.err;
    for (const auto& channel : nlohmann::json::parse(no.out).at("channels")) {
        EXPECT_LE(channel.at("max_error").get<double>(), 1e-3 * (1.0 + 1e-3));
        EXPECT_GT(channel.at("max_error").get<double>(), 5e-4);
        EXPECT_GT(channel.at("mean_error").get<double>(), 0.0) << "the sign of e";
    }
    EXPECT_EQ(
        run_aphotic(folder.path(), {"compare", "b/image.exr", "a/image.exr", "--bound", "1.1e-3"})
            .status,
        0);
    EXPECT_EQ(run_aphotic(folder.path(), {"compare", "a/image.exr", "no.exr"}).status, 2);
}

}  // namespace
}  // namespace aphotic
