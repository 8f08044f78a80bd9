// SPDX-License-Identifier: BSD-3-Clause
//
// Large work in shares, as several machines would do it: side by side, without a lock between them.
// Joined, it is bit for bit what one machine makes.
#include "support/command_under_way.h"
#include "support/has.h"
#include "support/run_command.h"
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

class Shares : public testing::Test {
  protected:
    [[nodiscard]] fs::path path(const std::string& name) const { return small_.folder() / name; }

    [[nodiscard]] CommandResult run(const Arguments& arguments) const {
        return run_aphotic(small_.folder(), arguments);
    }

    void run_well(const Arguments& arguments) const {
        const CommandResult result = run(arguments);
        ASSERT_EQ(result.status, 0) << result.err << testing::PrintToString(arguments);
    }

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
            for (const auto& entry : fs::recursive_directory_iterator(path(folder))) {
                const std::string name = fs::relative(entry.path(), path(folder)).string();
                if (entry.path().extension() != ".exr") continue;
                if (name.find("povray") != std::string::npos) continue;  // these tell the time
                const std::string bytes = read_text_file(entry.path());
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

    SmallRig small_;
};

TEST_F(Shares, OfARendersFrames) {
    run_well("render rig.toml --bands 13 -o one");
    run_well("generate rig.toml --bands 13 -o many");
    run_shares({"render", path("many").string()}, "--frames", 2);
    EXPECT_FALSE(fs::exists(path("many/image.exr")));
    run_well("integrate many");
    expect_same_files("one", "many");
    // Joined frames are noted as rendered: nothing is left to do.
    const CommandResult again = run("render rig.toml --bands 13 -o many --json");
    EXPECT_EQ(nlohmann::json::parse(again.out).at("frames_rendered"), 0) << again.out;
}

TEST_F(Shares, OneOfOneIsRenderedInPlace) {
    run_well("render rig.toml --bands 13 -o one");
    run_well("generate rig.toml --bands 13 -o many");
    run_well("render many --frames 1/1");
    run_well("integrate many");
    expect_same_files("one", "many");
}

TEST_F(Shares, OfFramesGoOnWhereTheyStopped) {
    run_well("generate rig.toml --bands 13 -o many");
    run_well("render many --frames 1/2");
    const auto second = nlohmann::json::parse(run("render many --frames 1/2 --json").out);
    EXPECT_EQ(second.at("frames_rendered"), 0);
    EXPECT_EQ(second.at("frames_kept"), 3);
    // What no share has rendered is missed by name, and rendered by render.
    const CommandResult missing = run("integrate many");
    EXPECT_EQ(missing.status, 3) << missing.err;
    run_well("render rig.toml --bands 13 -o many");
    run_well("render rig.toml --bands 13 -o one");
    expect_same_files("one", "many");
}

class SurveyShares : public Shares {
  protected:
    void SetUp() override { run_well("survey rig.toml --images 9 -o survey"); }

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
    run_well(correct("one"));
    run_shares(correct("many"), "--share", 2);
    const CommandResult joined = run(correct("many") + "--json");
    ASSERT_EQ(joined.status, 0) << joined.err;
    const auto json = nlohmann::json::parse(joined.out);
    EXPECT_EQ(json.at("corrected"), 0);
    EXPECT_EQ(json.at("kept"), 9);
    const auto alone = nlohmann::json::parse(read_text_file(path("one/correction.json")));
    for (const char* key : {"gain", "settings_sha256", "doubtful", "gain_from"})
        EXPECT_EQ(json.at(key), alone.at(key)) << key;
    expect_same_files("one", "many");
}

// Each learns the pattern of the whole survey.
TEST_F(SurveyShares, OfABaseline) {
    const Arguments baseline("baseline log-polynomial");
    run_well(correct("one", baseline));
    run_shares(correct("many", baseline), "--share", 2);
    const auto json = nlohmann::json::parse(run(correct("many", baseline) + "--json").out);
    EXPECT_EQ(json.at("corrected"), 0);
    EXPECT_EQ(json.at("kept"), 9);
    expect_same_files("one", "many");
}

TEST_F(SurveyShares, WhatNoShareHasDoneIsDoneWhenTheyAreJoined) {
    run_well(correct("one"));
    run_well(correct("many") + "--share 2/3");
    const auto json = nlohmann::json::parse(run(correct("many") + "--json").out);
    EXPECT_EQ(json.at("corrected"), 6);
    EXPECT_EQ(json.at("kept"), 3);
    expect_same_files("one", "many");
}

TEST_F(Shares, SayWhatIsWrong) {
    const auto expect = [&](const Arguments& arguments, const std::string& part) {
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_TRUE(has(result.err, part));
    };
    expect("render rig.toml", "--output: is missing");
    expect("render rig.toml --frames 1/2", "found no manifest.json");
    expect("render lamps --frames 3/2", "found 3/2; allowed: I/N");
    expect("render lamps --frames 1/2 --bands 3",
           "--bands: found with --frames; allowed: with a rig");
    expect("correct survey -o out --share x", "allowed: I/N");
}

}  // namespace
}  // namespace aphotic::shares_test
