// SPDX-License-Identifier: BSD-3-Clause
//
// --set KEY=VALUE: the rig is what its file would be with that text.
#include "support/exr_file.h"
#include "support/has.h"
#include "support/run_command.h"
#include "support/small_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

namespace aphotic::set_test {
namespace {

namespace fs = std::filesystem;

class CommandSet : public SmallRigTest {
  protected:
    [[nodiscard]] nlohmann::json plan(const Arguments& settings) const {
        return json_by("plan rig.toml --json" + settings);
    }
};

// Bit for bit, digest and all: comments and layout stay as they are.
TEST_F(CommandSet, IsTheRigThatItsFileWouldBe) {
    done("lightmap rig.toml --set sled.altitude_m=1.5 --set water.multiple=2 -o set.exr");
    const auto planned = plan("--set sled.altitude_m=1.5 --set water.multiple=2");
    EXPECT_EQ(planned["rig_settings"], nlohmann::json({"sled.altitude_m=1.5", "water.multiple=2"}));
    // As an editor would leave it.
    std::string text = text_of("rig.toml");
    text = std::regex_replace(text, std::regex(R"((\n\s*altitude_m\s*=\s*)[0-9.]+)"), "$011.5");
    text = std::regex_replace(text, std::regex(R"((\n\s*multiple\s*=\s*)[0-9.]+)"), "$012");
    write_file(path("rig.toml"), text);
    done("lightmap rig.toml -o edited.exr");
    EXPECT_TRUE(text_of("set.exr") == text_of("edited.exr"));
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
        done("generate rig.toml -o out" + settings);
        return json_in("out/manifest.json");
    };
    const auto plain = manifest({});
    const auto set = manifest("--set sled.altitude_m=3");
    EXPECT_FALSE(plain.contains("rig_settings"));
    EXPECT_EQ(set["rig_settings"]["keys"], nlohmann::json({"sled.altitude_m=3"}));
    EXPECT_NE(set["rig_sha256"], plain["rig_sha256"]);
    EXPECT_NE(set["frames"][0]["scene_sha256"], plain["frames"][0]["scene_sha256"]);
    refused("render out --frames 1/2 --set sled.altitude_m=2",
            "aphotic: --set: found with --frames; allowed: with a rig\n");
}

// --scale is the key that it sets, for what makes images of a rig.
TEST_F(CommandSet, ScalesTheCamera) {
    const auto small = plan("--scale 0.5");
    EXPECT_EQ(small["rig_settings"], nlohmann::json({"camera.scale=0.5"}));
    EXPECT_EQ(small, plan("--set camera.scale=0.5"));
    EXPECT_EQ(small["width_px"].get<int>(), (plan({})["width_px"].get<int>() + 1) / 2);
    refused("trace rig.toml -o out --scale 2", "--scale: found 2; allowed: 0.001 to 1");
    for (const std::string& command :
         Arguments("render plan generate trace validate study lightmap survey fit correct"))
        EXPECT_EQ(has(aphotic(fmt::format("{} --help", command)).out, "\n  --scale FACTOR "),
                  command != "fit" && command != "correct")
            << command;
}

// HabCam's lamps are symmetrical about its axis: cameras as far to port and to starboard see images
// that are each other's mirror images.
TEST_F(CommandSet, ChoosesACamera) {
    constexpr std::size_t kWidth = 16;
    const std::string text = with(text_of("rig.toml"), {{"pixel_pitch_um", "500.0"}});
    write_file(path("rig.toml"), text);
    const std::size_t first = text.find("[camera]");
    const std::size_t end = text.find("[water]");
    const std::string keys = text.substr(first + 9, end - first - 9);
    const auto camera = [&](const char* name, double y_m) {
        return fmt::format(
            "[[camera]]\nname = \"{}\"\nposition_m = [0, {}, 0]\n{}", name, y_m, keys);
    };
    write_file(path("sled.toml"),
               text.substr(0, first) + camera("middle", 0.0) + camera("left", -0.2) +
                   camera("right", 0.2) + text.substr(end));
    for (const char* name : {"middle", "left", "right"})
        done(fmt::format("lightmap sled.toml --camera {0} -o {0}.exr", name));
    done("lightmap rig.toml -o rig.exr");
    EXPECT_EQ(read_exr(path("middle.exr")), read_exr(path("rig.exr")));
    const std::vector<float> left = read_exr(path("left.exr"));
    const std::vector<float> right = read_exr(path("right.exr"));
    constexpr double kMapError = 4e-5;  // of two maps, each to 1.2e-5, and the lamps' edges apart
    double apart = 0.0;
    std::size_t edges = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const double mirrored = right[i / kWidth * kWidth + kWidth - 1 - i % kWidth];
        edges += std::abs(left[i] / mirrored - 1.0) > kMapError ? 1U : 0U;
        apart = std::max(apart, std::abs(left[i] / right[i] - 1.0));
    }
    EXPECT_EQ(edges, 0U);
    EXPECT_GT(apart, 0.1) << "they see different light";
    refused("lightmap sled.toml -o x.exr",
            "allowed: one of them, by --camera middle or left or right");
    refused("lightmap sled.toml --camera top -o x.exr",
            "found no camera 'top'; allowed: middle, left, right");
    refused("lightmap rig.toml --camera top -o x.exr",
            "found one camera, not called 'top'; allowed: no --camera");
    EXPECT_EQ(json_by("plan sled.toml --camera left --json")["rig_settings"],
              nlohmann::json({"camera=left"}));
}

TEST_F(CommandSet, RefusesWhatTheReaderRefuses) {
    write_file(path("beam.csv"), "angle_deg,intensity\n0,1\n90,0\n");
    fs::create_directory(path("raw"));
    for (const auto& [setting, why] :
         Cases{{"sled.altitud_m=2", "--set sled.altitud_m=2: rig.toml:"},
               {"sled.altitud_m=2", "sled.altitud_m: "},
               {"sled.altitude_m=-1", "allowed"},
               {"sled.altitude_m=high", "found 'high'; allowed: a number"},
               {"strobe.for.power=2", "aft"},
               {"sled.altitude_m", "--set: found sled.altitude_m; allowed: KEY=VALUE"},
               {"sled.altitude_m=", "--set: found sled.altitude_m=; allowed: KEY=VALUE"},
               {"=2", "--set: found =2; allowed: KEY=VALUE"}})
        refused("trace rig.toml -o out --set" + setting, why);
    refused("beam beam.csv --set sled.altitude_m=2",
            "--set: found with beam.csv; allowed: with a rig");
    refused("correct raw --map m.exr -o out --set title=x", "--rig");
}

TEST_F(CommandSet, IsOfEveryCommandThatReadsARig) {
    for (const std::string& command :
         Arguments("render plan generate integrate trace lightmap design correct observe fit "
                   "baseline survey validate study beam"))
        for (const char* option : {"--set KEY=VALUE ", "--camera NAME "})
            EXPECT_TRUE(
                has(aphotic(fmt::format("{} --help", command)).out, fmt::format("\n  {}", option)))
                << command;
    for (const char* command : {"compare", "data", "help"})
        EXPECT_FALSE(has(aphotic(fmt::format("{} --help", command)).out, "--set")) << command;
}

}  // namespace
}  // namespace aphotic::set_test
