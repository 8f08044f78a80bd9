// SPDX-License-Identifier: BSD-3-Clause
//
// Large work in shares, as several machines would do it: side by side, without a lock between them.
// Joined, it is bit for bit what one machine makes.
#include "support/command_under_way.h"
#include "support/small_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace aphotic::shares_test {
namespace {

namespace fs = std::filesystem;
constexpr auto kLongest = std::chrono::minutes(15);  // for what hangs

class Shares : public SmallRigTest {
  protected:
    // All shares at once, blind to each other.
    void run_shares(const Arguments& arguments, const std::string& option, int of) const {
        const std::map<std::string, std::string> no_locks{
            {"LD_PRELOAD", APHOTIC_NO_LOCKS}, {"ASAN_OPTIONS", "verify_asan_link_order=0"}};
        const TempFolder streams;
        std::vector<std::unique_ptr<Command>> commands;
        for (int number = 1; number <= of; ++number) {
            const fs::path lane = streams.path() / std::to_string(number);
            fs::create_directories(lane);
            commands.push_back(std::make_unique<Command>(
                lane, arguments + fmt::format("{} {}/{}", option, number, of), no_locks));
        }
        for (std::size_t i = 0; i < commands.size(); ++i)
            EXPECT_EQ(commands[i]->wait(kLongest), 0)
                << read_text_file(streams.path() / std::to_string(i + 1) / "stderr");
    }

    // Every file of one folder that has this extension, in the other, and none but these.
    void expect_same_files(const std::string& one, const std::string& other) const {
        std::map<std::string, std::string> found;
        for (const std::string& folder : {one, other}) {
            for (const auto& [name, bytes] : files_in(folder)) {
                if (!name.ends_with(".exr")) continue;
                if (name.find("povray") != std::string::npos) continue;  // these tell the time
                const auto [known, is_new] = found.emplace(name, bytes);
                EXPECT_EQ(is_new, folder == one) << name;
                EXPECT_TRUE(known->second == bytes) << name;
            }
        }
        EXPECT_FALSE(found.empty());
        for (const auto& entry : fs::directory_iterator(path(other)))
            EXPECT_FALSE(entry.path().filename().string().starts_with("share-")) << entry.path();
        expect_no_leftovers(path(other));
    }
};

TEST_F(Shares, OfARendersFrames) {
    done("render rig.toml --bands 13 -o one");
    done("generate rig.toml --bands 13 -o many");
    run_shares({"render", path("many").string()}, "--frames", 2);
    EXPECT_FALSE(fs::exists(path("many/image.exr")));
    done("integrate many");
    expect_same_files("one", "many");
    // Joined frames are noted as rendered: nothing is left to do.
    EXPECT_EQ(json_by("render rig.toml --bands 13 -o many --json").at("frames_rendered"), 0);
}

TEST_F(Shares, OneOfOneIsRenderedInPlace) {
    done("render rig.toml --bands 13 -o one");
    done("generate rig.toml --bands 13 -o many");
    done("render many --frames 1/1");
    done("integrate many");
    expect_same_files("one", "many");
}

TEST_F(Shares, OfFramesGoOnWhereTheyStopped) {
    done("generate rig.toml --bands 13 -o many");
    done("render many --frames 1/2");
    const auto second = json_by("render many --frames 1/2 --json");
    EXPECT_EQ(second.at("frames_rendered"), 0);
    EXPECT_EQ(second.at("frames_kept"), 3);
    // What no share has rendered is missed by name, and rendered by render.
    refused(aphotic("integrate many"), "band_486_511_535nm", kRunFailed);
    done("render rig.toml --bands 13 -o many");
    done("render rig.toml --bands 13 -o one");
    expect_same_files("one", "many");
}

class SurveyShares : public Shares {
  protected:
    void SetUp() override { done("survey rig.toml --images 9 -o survey"); }

    [[nodiscard]] Arguments correct(const std::string& folder,
                                    const Arguments& command = "correct") const {
        return command +
               Arguments{path("survey/raw").string(),
                         "--rig",
                         path("rig.toml").string(),
                         "--nav",
                         path("survey/navigation-measured.txt").string(),
                         "-o",
                         path(folder).string()} +
               "--bayer RGGB --black-level 64 --white-level 4095 --format exr";
    }
};

TEST_F(SurveyShares, OfASurveysImages) {
    done(correct("one"));
    run_shares(correct("many"), "--share", 2);
    const auto json = json_by(correct("many") + "--json");
    EXPECT_EQ(json.at("corrected"), 0);
    EXPECT_EQ(json.at("kept"), 9);
    const auto alone = json_in("one/correction.json");
    for (const char* key : {"gain", "settings_sha256", "doubtful", "gain_from"})
        EXPECT_EQ(json.at(key), alone.at(key)) << key;
    expect_same_files("one", "many");
}

// Each learns the pattern of the whole survey.
TEST_F(SurveyShares, OfABaseline) {
    const Arguments baseline("baseline log-polynomial");
    done(correct("one", baseline));
    run_shares(correct("many", baseline), "--share", 2);
    const auto json = json_by(correct("many", baseline) + "--json");
    EXPECT_EQ(json.at("corrected"), 0);
    EXPECT_EQ(json.at("kept"), 9);
    expect_same_files("one", "many");
}

TEST_F(SurveyShares, WhatNoShareHasDoneIsDoneWhenTheyAreJoined) {
    done(correct("one"));
    done(correct("many") + "--share 2/3");
    const auto json = json_by(correct("many") + "--json");
    EXPECT_EQ(json.at("corrected"), 6);
    EXPECT_EQ(json.at("kept"), 3);
    expect_same_files("one", "many");
}

TEST_F(Shares, SayWhatIsWrong) {
    for (const auto& [command, why] :
         Cases{{"render rig.toml", "--output: is missing"},
               {"render rig.toml --frames 1/2", "found no manifest.json"},
               {"render lamps --frames 3/2", "found 3/2; allowed: I/N"},
               {"render lamps --frames 1/2 --bands 3",
                "--bands: found with --frames; allowed: with a rig"},
               {"correct survey -o out --share x", "allowed: I/N"}})
        refused(command, why);
}

}  // namespace
}  // namespace aphotic::shares_test
