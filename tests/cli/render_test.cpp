// SPDX-License-Identifier: BSD-3-Clause
//
// The main job as a user runs it.
#include "image/exr.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::render_test {
namespace {

namespace fs = std::filesystem;

class CommandRender : public CommandTest {
  protected:
    void SetUp() override { write_file(path("rig.toml"), small_scene("habcam.toml")); }
};

TEST_F(CommandRender, LeavesWhatTheDesignPromises) {
    const CommandResult run = done("render rig.toml -o out --bands 6", "2 frames rendered, 0 kept");
    EXPECT_EQ(run.err, "");
    for (const char* file :
         {"image.exr", "spectral.exr", "preview.png", "manifest.json", "povray/render.ini"}) {
        EXPECT_TRUE(fs::exists(path("out") / file)) << file;
    }
    const ExrReader image(path("out/image.exr"));
    EXPECT_EQ(image.width_px(), 34);
    EXPECT_EQ(image.height_px(), 25);
    EXPECT_EQ(image.channels(), (std::vector<std::string>{"B", "G", "R"}));
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(home_)) {
        EXPECT_FALSE(has(entry.path().filename().string(), ".part")) << entry.path();
    }
}

// Water takes red before green before blue: against air, at every pixel's expense.
TEST_F(CommandRender, WaterTakesRedFirst) {
    const auto means = [&](const std::string& multiple) {
        write_file(path("m.toml"), with(text_of("rig.toml"), {{"multiple", multiple}}));
        return json_by(fmt::format("render m.toml -o {} --bands 12 --json", multiple)).at("signal");
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
    const CommandResult generated = done("generate rig.toml -o by-hand" + wavelengths);
    // The commands that it prints, as they stand.
    const std::string povray_line = generated.out.substr(generated.out.find("  (cd "));
    ASSERT_TRUE(by_shell(povray_line.substr(0, povray_line.find('\n'))).succeeded())
        << text_of("log");
    done("integrate by-hand");

    done("render rig.toml -o by-us" + wavelengths);
    EXPECT_EQ(text_of("by-hand/preview.png"), text_of("by-us/preview.png"));
}

TEST_F(CommandRender, PlanSaysWhatRenderWillDo) {
    const auto json = json_by("plan rig.toml --wavelengths 478,576,638,700 --json");
    EXPECT_EQ(json["frames"], 2);
    ASSERT_EQ(json["wavelengths"].size(), 4U);
    EXPECT_EQ(json["wavelengths"][1]["lambda_nm"], 576.0);
    EXPECT_EQ(json["wavelengths"][2]["frame"], "band_478_576_638nm");
    EXPECT_FALSE(fs::exists(path("out"))) << "a plan renders nothing";
}

}  // namespace
}  // namespace aphotic::render_test
