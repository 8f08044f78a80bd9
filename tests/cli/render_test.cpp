// SPDX-License-Identifier: BSD-3-Clause
//
// The main job as a user runs it.
#include "image/exr.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>

namespace aphotic::render_test {
namespace {

namespace fs = std::filesystem;

// A copy of a scene with few pixels over the same field of view.
std::string small_scene(const std::string& name) {
    std::string text = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/" + name);
    text = std::regex_replace(
        text, std::regex(R"(\n\s*resolution\s*=[^\n]*)"), "\nresolution = [34, 26]");
    return std::regex_replace(
        text, std::regex(R"(\n\s*pixel_pitch_um\s*=[^\n]*)"), "\npixel_pitch_um = 258.0");
}

class CommandRender : public CommandTest {
  protected:
    void SetUp() override { write_file(path("rig.toml"), small_scene("habcam.toml")); }
};

TEST_F(CommandRender, LeavesWhatTheDesignPromises) {
    const CommandResult run = aphotic("render rig.toml -o out --bands 6");
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(has(run.out, "2 frames rendered, 0 kept"));
    EXPECT_EQ(run.err, "");
    for (const char* file :
         {"image.exr", "spectral.exr", "preview.png", "manifest.json", "povray/render.ini"}) {
        EXPECT_TRUE(fs::exists(path("out") / file)) << file;
    }
    const ExrReader image(path("out") / "image.exr");
    EXPECT_EQ(image.width_px(), 34);
    EXPECT_EQ(image.height_px(), 26);
    EXPECT_EQ(image.channels(), (std::vector<std::string>{"B", "G", "R"}));
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path())) {
        EXPECT_EQ(entry.path().filename().string().find(".part"), std::string::npos)
            << entry.path();
    }
}

// Water takes red before green before blue: against air, at every pixel's expense.
TEST_F(CommandRender, WaterTakesRedFirst) {
    const auto means = [&](const std::string& multiple) {
        const std::string rig = std::regex_replace(small_scene("habcam.toml"),
                                                   std::regex(R"(\nmultiple\s*=[^\n]*)"),
                                                   "\nmultiple = " + multiple);
        write_file(path("m.toml"), rig);
        const CommandResult run =
            aphotic(fmt::format("render m.toml -o {} --bands 12 --json", multiple));
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(run.out).at("signal");
    };
    const auto air = means("0.0");
    const auto water = means("1.0");
    const auto left = [&](const char* c) {
        return water[c]["mean"].get<double>() / air[c]["mean"].get<double>();
    };
    EXPECT_LT(left("R"), left("G"));
    EXPECT_LT(left("G"), left("B"));
    EXPECT_LT(left("B"), 1.0);
}

TEST_F(CommandRender, GenerateAndIntegrateMakeTheSameImage) {
    const Arguments wavelengths("--wavelengths 478,576,638");
    const CommandResult generated = aphotic("generate rig.toml -o by-hand" + wavelengths);
    ASSERT_EQ(generated.status, 0) << generated.err;
    // The commands that it prints, as they stand.
    const std::string povray_line = generated.out.substr(generated.out.find("  (cd "));
    write_file(path("render.sh"), povray_line.substr(0, povray_line.find('\n')));
    const ProcessEnd end = run_process({.executable = "/bin/sh",
                                        .arguments = {"render.sh"},
                                        .folder = folder_.path(),
                                        .environment = {},
                                        .log = path("log")},
                                       60.0);
    ASSERT_TRUE(end.succeeded()) << text_of("log");
    const CommandResult integrated = aphotic("integrate by-hand");
    ASSERT_EQ(integrated.status, 0) << integrated.err;

    ASSERT_EQ(aphotic("render rig.toml -o by-us" + wavelengths).status, 0);
    EXPECT_EQ(read_text_file(path("by-hand") / "preview.png"),
              read_text_file(path("by-us") / "preview.png"));
}

TEST_F(CommandRender, PlanSaysWhatRenderWillDo) {
    const CommandResult plan = aphotic("plan rig.toml --wavelengths 478,576,638,700 --json");
    ASSERT_EQ(plan.status, 0) << plan.err;
    const auto json = nlohmann::json::parse(plan.out);
    EXPECT_EQ(json["frames"], 2);
    ASSERT_EQ(json["wavelengths"].size(), 4U);
    EXPECT_EQ(json["wavelengths"][1]["lambda_nm"], 576.0);
    EXPECT_EQ(json["wavelengths"][2]["frame"], "band_478_576_638nm");
    EXPECT_FALSE(fs::exists(path("out"))) << "a plan renders nothing";
}

}  // namespace
}  // namespace aphotic::render_test
