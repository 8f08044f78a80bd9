// SPDX-License-Identifier: BSD-3-Clause
//
// The main job as a user runs it.
#include "image/exr.h"
#include "support/run_command.h"
#include "support/small_scene.h"

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

class CommandRender : public testing::Test {
  protected:
    void SetUp() override { write_file(folder_.path() / "rig.toml", small_scene("habcam.toml")); }

    TempFolder folder_;
};

TEST_F(CommandRender, LeavesWhatTheDesignPromises) {
    const CommandResult run =
        run_aphotic(folder_.path(), {"render", "rig.toml", "-o", "out", "--bands", "6"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("2 frames rendered, 0 kept"), std::string::npos) << run.out;
    EXPECT_EQ(run.err, "");
    for (const char* file :
         {"image.exr", "spectral.exr", "preview.png", "manifest.json", "povray/render.ini"}) {
        EXPECT_TRUE(fs::exists(folder_.path() / "out" / file)) << file;
    }
    const ExrReader image(folder_.path() / "out" / "image.exr");
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
        write_file(folder_.path() / "m.toml", rig);
        const CommandResult run = run_aphotic(
            folder_.path(), {"render", "m.toml", "-o", multiple, "--bands", "12", "--json"});
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
    const std::vector<std::string> wavelengths{"--wavelengths", "478,576,638"};
    std::vector<std::string> generate{"generate", "rig.toml", "-o", "by-hand"};
    generate.insert(generate.end(), wavelengths.begin(), wavelengths.end());
    const CommandResult generated = run_aphotic(folder_.path(), generate);
    ASSERT_EQ(generated.status, 0) << generated.err;
    // The commands that it prints, as they stand.
    const std::string povray_line = generated.out.substr(generated.out.find("  (cd "));
    write_file(folder_.path() / "render.sh", povray_line.substr(0, povray_line.find('\n')));
    const ProcessEnd end = run_process({.executable = "/bin/sh",
                                        .arguments = {"render.sh"},
                                        .folder = folder_.path(),
                                        .environment = {},
                                        .log = folder_.path() / "log"},
                                       60.0);
    ASSERT_TRUE(end.succeeded()) << read_text_file(folder_.path() / "log");
    const CommandResult integrated = run_aphotic(folder_.path(), {"integrate", "by-hand"});
    ASSERT_EQ(integrated.status, 0) << integrated.err;

    std::vector<std::string> render{"render", "rig.toml", "-o", "by-us"};
    render.insert(render.end(), wavelengths.begin(), wavelengths.end());
    ASSERT_EQ(run_aphotic(folder_.path(), render).status, 0);
    EXPECT_EQ(read_text_file(folder_.path() / "by-hand" / "preview.png"),
              read_text_file(folder_.path() / "by-us" / "preview.png"));
}

TEST_F(CommandRender, PlanSaysWhatRenderWillDo) {
    const CommandResult plan = run_aphotic(
        folder_.path(), {"plan", "rig.toml", "--wavelengths", "478,576,638,700", "--json"});
    ASSERT_EQ(plan.status, 0) << plan.err;
    const auto json = nlohmann::json::parse(plan.out);
    EXPECT_EQ(json["frames"], 2);
    ASSERT_EQ(json["wavelengths"].size(), 4U);
    EXPECT_EQ(json["wavelengths"][1]["lambda_nm"], 576.0);
    EXPECT_EQ(json["wavelengths"][2]["frame"], "band_478_576_638nm");
    EXPECT_FALSE(fs::exists(folder_.path() / "out")) << "a plan renders nothing";
}

}  // namespace
}  // namespace aphotic::render_test
