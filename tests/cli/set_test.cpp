// SPDX-License-Identifier: BSD-3-Clause
//
// --set KEY=VALUE: the rig is what its file would be with that text.
#include "support/has.h"
#include "support/run_command.h"
#include "support/small_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>
#include <string>
#include <vector>

namespace aphotic::set_test {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;

class CommandSet : public testing::Test {
  protected:
    [[nodiscard]] CommandResult run(const Arguments& arguments) const {
        return run_aphotic(small_.folder(), arguments);
    }

    [[nodiscard]] nlohmann::json plan(const Arguments& settings) const {
        const CommandResult planned = run("plan rig.toml --json" + settings);
        EXPECT_EQ(planned.status, 0) << planned.err;
        return planned.status == 0 ? nlohmann::json::parse(planned.out) : nlohmann::json{};
    }

    // The rig's file with other values, as an editor would leave it.
    void edit(const std::string& pattern, const std::string& text) const {
        const std::string before = read_text_file(small_.folder() / "rig.toml");
        const std::string after = std::regex_replace(before, std::regex(pattern), text);
        ASSERT_NE(before, after) << pattern;
        write_file(small_.folder() / "rig.toml", after);
    }

    void expect_refused(const std::string& words, const Arguments& arguments) const {
        const CommandResult refused = run(arguments);
        EXPECT_EQ(refused.status, kBadInput) << testing::PrintToString(arguments);
        EXPECT_TRUE(has(refused.err, words));
        EXPECT_FALSE(fs::exists(small_.folder() / "out")) << words;
    }

    SmallRig small_;
};

// Bit for bit, digest and all: comments and layout stay as they are.
TEST_F(CommandSet, IsTheRigThatItsFileWouldBe) {
    ASSERT_EQ(
        run("lightmap rig.toml --set sled.altitude_m=1.5 --set water.multiple=2 -o set.exr").status,
        0);
    const auto planned = plan("--set sled.altitude_m=1.5 --set water.multiple=2");
    EXPECT_EQ(planned["rig_settings"], nlohmann::json({"sled.altitude_m=1.5", "water.multiple=2"}));
    edit(R"((\n\s*altitude_m\s*=\s*)[0-9.]+)", "$011.5");
    edit(R"((\n\s*multiple\s*=\s*)[0-9.]+)", "$012");
    ASSERT_EQ(run("lightmap rig.toml -o edited.exr").status, 0);
    EXPECT_TRUE(read_text_file(small_.folder() / "set.exr") ==
                read_text_file(small_.folder() / "edited.exr"));
    auto edited = plan({});
    EXPECT_FALSE(edited.contains("rig_settings"));
    edited["rig_settings"] = planned["rig_settings"];
    EXPECT_EQ(planned, edited);
}

TEST_F(CommandSet, TakesWordsTextsAndListsAndTheLastOfAKey) {
    const auto digest = [&](const std::string& setting) {
        return plan(fmt::format("--set {}", setting))["rig_sha256"].get<std::string>();
    };
    EXPECT_EQ(digest("strobe.fore.spectrum=xenon-flash"),
              digest("strobe.fore.spectrum=\"xenon-flash\""));
    EXPECT_NE(digest("strobe.fore.spectrum=xenon-flash"), plan({})["rig_sha256"]);
    EXPECT_EQ(plan({"--set", "camera.resolution=[8, 6]"})["width_px"], 8);
    EXPECT_EQ(plan("--set sled.altitude_m=3 --set sled.altitude_m=2.5")["rig_sha256"],
              digest("sled.altitude_m=2.5"));
}

// So that frames of one are not taken for another's.
TEST_F(CommandSet, StandsInTheManifest) {
    const auto manifest = [&](const Arguments& settings) {
        const CommandResult made = run("generate rig.toml -o out" + settings);
        EXPECT_EQ(made.status, 0) << made.err;
        return nlohmann::json::parse(read_text_file(small_.folder() / "out/manifest.json"));
    };
    const auto plain = manifest({});
    const auto set = manifest("--set sled.altitude_m=3");
    EXPECT_FALSE(plain.contains("rig_settings"));
    EXPECT_EQ(set["rig_settings"]["keys"], nlohmann::json({"sled.altitude_m=3"}));
    EXPECT_NE(set["rig_sha256"], plain["rig_sha256"]);
    EXPECT_NE(set["frames"][0]["scene_sha256"], plain["frames"][0]["scene_sha256"]);
    EXPECT_EQ(run("render out --frames 1/2 --set sled.altitude_m=2").err,
              "aphotic: --set: found with --frames; allowed: with a rig\n");
}

TEST_F(CommandSet, RefusesWhatTheReaderRefuses) {
    const auto trace = [](const std::string& setting) {
        return Arguments(fmt::format("trace rig.toml -o out --set {}", setting));
    };
    expect_refused("--set sled.altitud_m=2: rig.toml:", trace("sled.altitud_m=2"));
    expect_refused("sled.altitud_m: ", trace("sled.altitud_m=2"));
    expect_refused("allowed", trace("sled.altitude_m=-1"));
    expect_refused("found 'high'; allowed: a number", trace("sled.altitude_m=high"));
    expect_refused("aft", trace("strobe.for.power=2"));
    expect_refused("--set: found sled.altitude_m; allowed: KEY=VALUE", trace("sled.altitude_m"));
    expect_refused("--set: found sled.altitude_m=; allowed: KEY=VALUE", trace("sled.altitude_m="));
    expect_refused("--set: found =2; allowed: KEY=VALUE", trace("=2"));
    write_file(small_.folder() / "beam.csv", "angle_deg,intensity\n0,1\n90,0\n");
    expect_refused("--set: found with beam.csv; allowed: with a rig",
                   "beam beam.csv --set sled.altitude_m=2");
    fs::create_directory(small_.folder() / "raw");
    expect_refused("--rig", "correct raw --map m.exr -o out --set title=x");
}

TEST_F(CommandSet, IsOfEveryCommandThatReadsARig) {
    for (const std::string& command :
         Arguments("render plan generate integrate trace lightmap design correct observe fit "
                   "baseline survey validate study beam"))
        EXPECT_NE(run(fmt::format("{} --help", command)).out.find("\n  --set KEY=VALUE "),
                  std::string::npos)
            << command;
    for (const char* command : {"compare", "data", "help"})
        EXPECT_EQ(run(fmt::format("{} --help", command)).out.find("--set"), std::string::npos)
            << command;
}

}  // namespace
}  // namespace aphotic::set_test
