// SPDX-License-Identifier: BSD-3-Clause
//
// Every scene of the project, small, through both renderers.
#include "support/command_test.h"
#include "support/has.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace aphotic::validate_test {
namespace {

class EveryScene : public CommandTest, public testing::WithParamInterface<std::filesystem::path> {};

TEST_P(EveryScene, Validates) {
    put_small_scene(GetParam(), home_);
    done("validate rig.toml -o out --wavelengths 410,470,550,620,700");
    const auto json = json_in("out/validation.json");
    EXPECT_EQ(json.at("wavelengths").size(), 5U);
    EXPECT_EQ(json.at("channels").size(), 3U);
    EXPECT_TRUE(std::filesystem::exists(path("out/report.html")));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, EveryScene, testing::ValuesIn(all_scenes()), [](const auto& scene) {
        std::string name =
            scene.param.parent_path().filename().string() + "_" + scene.param.stem().string();
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
        return name;
    });

using Validate = CommandTest;

// The reference's share of veil is the lightmap's, and stands on the page.
TEST_F(Validate, TellsHowMuchIsVeil) {
    constexpr double kOfBoth = 1e-3;  // of the share: both know the veil to 1e-4
    const std::string rig = with(small_scene("habcam.toml"), {{"range_nm", "[400, 700]"}});
    write_file(path("rig.toml"),
               replaced(rig, "absorption = \"pope-fry-1997\"", "type = \"jerlov-1C\""));
    const auto traced =
        json_by("validate rig.toml -o out --json --model-tolerance 1").at("veil_in_the_middle");
    const auto mapped =
        json_by("lightmap rig.toml -o map.exr --json --model-tolerance 1").at("veil_in_the_middle");
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_GT(mapped[c].get<double>(), 0.1);
        EXPECT_NEAR(traced[c].get<double>() / mapped[c].get<double>(), 1.0, kOfBoth) << c;
    }
    EXPECT_TRUE(has(text_of("out/report.html"), "Veil in the middle"));
    // The same among maps of several altitudes.
    const auto maps =
        json_by("lightmap rig.toml -o maps --altitude 2,2.5 --json --model-tolerance 1")["maps"];
    EXPECT_EQ(maps[0]["altitude_m"], 2.0);
    EXPECT_EQ(maps[0]["veil_in_the_middle"], mapped);
}

// Wavelengths that share a frame behind a port may be shifted, and their bound is the wider for it.
// Each in a frame of its own has none of that.
TEST_F(Validate, APortWithoutSharedFramesIsHeldToTheHalfFloatsAlone) {
    constexpr double kHalfFloatBound = 6e-4;
    write_file(path("rig.toml"), small_scene("port.toml"));
    const auto json =
        json_by("validate rig.toml -o out --per-frame 1 --wavelengths 410,470,550,620,700 --json");
    EXPECT_EQ(json.at("frames"), 5);
    ASSERT_EQ(json.at("wavelengths").size(), 5U);
    for (const auto& wavelength : json.at("wavelengths")) {
        EXPECT_EQ(wavelength.at("bound").get<double>(), kHalfFloatBound) << wavelength.dump();
        EXPECT_LE(wavelength.at("max_error").get<double>(), kHalfFloatBound) << wavelength.dump();
    }
}

// Equal bands: their error is most of the promise, and nearly reached.
TEST_F(Validate, PromiseOfBandsHoldsAndIsNoMoreThanFiveTimesTheErrorFound) {
    write_file(path("rig.toml"), small_scene("habcam.toml"));
    const auto json = json_by("validate rig.toml -o out --bands 9 --json");
    for (const auto& channel : json.at("channels")) {
        const double promised = channel.at("bound").get<double>();
        const double found = channel.at("max_error").get<double>();
        EXPECT_GT(found, promised / 5.0) << channel.dump();
    }
}

using Trace = CommandTest;

TEST_F(Trace, LeavesImagesWithoutPovRayAndThreadsChangeNoBit) {
    write_file(path("rig.toml"), small_scene("port.toml"));
    const std::map<std::string, std::string> no_povray{{"APHOTIC_POVRAY", "/no/povray"}};
    for (const std::string threads : {"1", "3"}) {
        done(aphotic(
            fmt::format("trace rig.toml -o {0} --threads {0} --wavelengths 470,550", threads),
            no_povray));
    }
    for (const char* file : {"image.exr", "spectral.exr", "preview.png"}) {
        EXPECT_EQ(read_text_file(path("1") / file), read_text_file(path("3") / file)) << file;
    }
}

// What it is exact to, and where not: 40 % of HabCam's pixels are in penumbrae; a port takes edges
// across some.
TEST_F(Trace, SaysWhereItsErrorsDoNotHold) {
    for (const std::string scene : {"habcam", "habcam-emitters", "port"}) {
        write_file(path("rig.toml"), small_scene(scene + ".toml"));
        const CommandResult run = done("trace rig.toml -o out", "of a signal off the edges");
        const auto json = json_in("out/trace.json");
        const bool has_emitters = scene == "habcam-emitters";
        EXPECT_EQ(run.out.find("pixels on the edge of") != std::string::npos, scene != "habcam")
            << run.out;
        EXPECT_EQ(json.at("on_edges").get<int>() > 0, scene != "habcam") << scene;
        EXPECT_EQ(json.contains("emitters"), has_emitters) << scene;
        if (!has_emitters) continue;
        EXPECT_GT(json.at("on_edges").get<int>(), 34 * 25 / 3);
        EXPECT_EQ(json.at("emitter_error").get<double>(), 2e-5);
        ASSERT_EQ(json.at("emitters").size(), 4U);
        EXPECT_EQ(json.at("emitters")[0].at("strobe"), "fore");
        EXPECT_GT(json.at("emitters")[0].at("lamps_across").get<int>(), 1);
        EXPECT_TRUE(has(run.out, "strobe 'fore' is traced as 10 x 5 lamps"));
    }
}

using Compare = CommandTest;

// `compare` reads any format: here a PNG against itself, and two EXRs that differ.
TEST_F(Compare, SaysYesAndNo) {
    write_file(path("rig.toml"), small_scene("habcam.toml"));
    done("trace rig.toml -o a");
    // One strobe of four brighter by a thousandth: up to 1e-3 in its cone, and nowhere more.
    write_file(path("brighter.toml"), text_of("rig.toml") + "power = 1.001\n");
    done("trace brighter.toml -o b");

    done("compare a/preview.png a/preview.png");
    const auto told = json_by("compare b/image.exr a/image.exr --bound 1e-4 --json", kAnswerIsNo);
    for (const auto& channel : told.at("channels")) {
        EXPECT_LE(channel.at("max_error").get<double>(), 1e-3 * (1.0 + 1e-3));
        EXPECT_GT(channel.at("max_error").get<double>(), 5e-4);
        EXPECT_GT(channel.at("mean_error").get<double>(), 0.0) << "the sign of e";
    }
    done("compare b/image.exr a/image.exr --bound 1.1e-3");
    EXPECT_EQ(aphotic("compare a/image.exr no.exr").status, 2);
}

}  // namespace
}  // namespace aphotic::validate_test
