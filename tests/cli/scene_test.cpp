// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes of the user's own through the command, from a folder with a blank in its name.
#include "image/exr.h"
#include "image/output_images.h"
#include "plugin/povray.h"
#include "spectral/manifest.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <regex>

namespace aphotic::scene_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFloor = "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n";

class UserScenes : public CommandTest {
  protected:
    UserScenes() : home_(path("my scenes")) {
        fs::create_directory(home_);
        put("rig.toml", small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"));
    }
    void put(const std::string& name, const std::string& text) { write_file(home_ / name, text); }
    void put_scene(const std::string& text, const std::string& name = "reef.pov") {
        put(name, "#version 3.7;\n#include \"aphotic.inc\"\n" + text);
    }
    CommandResult aphotic(const Arguments& arguments) { return run_aphotic(home_, arguments); }
    nlohmann::json rendered(const std::string& folder, const Arguments& more = {}) {
        const CommandResult run =
            aphotic(fmt::format("render rig.toml --scene reef.pov -o {} --json", folder) + more);
        EXPECT_EQ(run.status, 0) << run.err;
        return run.status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
    }
    [[nodiscard]] std::vector<float> signals(const std::string& folder) const {
        return read_signals(home_ / folder / "image.exr").samples;
    }

    fs::path home_;
};

TEST_F(UserScenes, ValidateLikeAnyOther) {
    put_scene(kFloor);
    const CommandResult run = aphotic("validate rig.toml --scene reef.pov -o out");
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    const std::string page = read_text_file(home_ / "out" / "report.html");
    EXPECT_TRUE(has(page, "reef.pov\u2069, a scene of the user’s own"))
        << "the page says what the reference did not read";
    const auto json = nlohmann::json::parse(read_text_file(home_ / "out" / "validation.json"));
    EXPECT_TRUE(json.at("rig").at("scene").get<std::string>().ends_with("reef.pov"));
    // A floor that is farther than the rig says must not pass.
    put_scene("Aphotic_Rig ()\nAphotic_Seafloor (2.05, 5, 0, \"sand\")\n");
    EXPECT_EQ(aphotic("validate rig.toml --scene reef.pov -o out").status, 1);
}

// Up to where what the scene shows stands.
TEST_F(UserScenes, HaveTheVeilOfWaterThatScatters) {
    std::string rig = read_text_file(home_ / "rig.toml");
    const auto replace = [&](const std::string& from, const std::string& to) {
        ASSERT_TRUE(has(rig, from)) << from;
        rig.replace(rig.find(from), from.size(), to);
    };
    replace("absorption = \"pope-fry-1997\"",
            "type = \"jerlov-1C\"\nphase = { fournier_forand = { backscatter_ratio = 0.0135 } }");
    replace("[400, 720]", "[400, 700]");
    put("rig.toml", rig);
    put_scene(kFloor);
    const Arguments validate("validate rig.toml --scene reef.pov -o out --model-tolerance 1");
    const CommandResult run = aphotic(validate);
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    // A floor that stands nearer has less before it, and the reference's has not.
    put_scene("Aphotic_Rig ()\nAphotic_Seafloor (1.95, 5, 0, \"sand\")\n");
    EXPECT_EQ(aphotic(validate).status, 1);
}

TEST_F(UserScenes, ARigMayNameItsScene) {
    put_scene(kFloor);
    const std::string rig = read_text_file(home_ / "rig.toml");
    put("rig.toml", "scene = \"reef.pov\"\n" + rig);
    const CommandResult plan = aphotic("plan rig.toml");
    EXPECT_EQ(plan.status, 0) << plan.err;
    EXPECT_TRUE(has(plan.out, "reef.pov uses sand"));
    // The reference knows no scene, and needs no POV-Ray.
    EXPECT_EQ(run_aphotic(home_, "trace rig.toml -o t", {{"APHOTIC_POVRAY", "none"}}).status, 0);
}

TEST_F(UserScenes, AreRenderedAgainWhenWhatTheyIncludeChanges) {
    put("things.inc", "#declare Size = 0.1;\n");
    put_scene(std::string(kFloor) +
              "#include \"things.inc\"\n"
              "sphere { <0, 0, 1.9>, Size pigment { Aphotic_Pigment (\"red-algae\") } }\n");
    const std::string scene = read_text_file(home_ / "reef.pov");
    const auto first = rendered("out");
    EXPECT_GT(first["frames_rendered"], 0);
    const std::vector<float> small = signals("out");
    EXPECT_EQ(rendered("out")["frames_rendered"], 0);
    EXPECT_EQ(signals("out"), small);
    put("things.inc", "#declare Size = 0.2;\n");
    EXPECT_EQ(rendered("out")["frames_kept"], 0);
    EXPECT_NE(signals("out"), small);
    EXPECT_EQ(read_text_file(home_ / "reef.pov"), scene) << "scenes are never modified";
}

// What plain povray renders from `generate` is what `render` renders.
TEST_F(UserScenes, GeneratedFramesRenderInPlainPovray) {
    put_scene(std::string(kFloor) +
              "#include \"colors.inc\"\n"
              "sphere { <0, 0, 1.9>, 0.2 pigment { Aphotic_Pigment (\"red-algae\") } }\n");
    rendered("out");
    const CommandResult generated = aphotic("generate rig.toml --scene reef.pov -o gen");
    ASSERT_EQ(generated.status, 0) << generated.err;
    for (const ManifestFrame& frame : read_manifest(home_ / "gen").frames) {
        const ProcessEnd end = run_process(
            {.executable = find_povray("").executable,
             .arguments = {"gen/povray/render.ini", "+Igen/povray/" + frame.name + ".pov"},
             .folder = home_,
             .environment = {},
             .log = path("log")},
            60.0);
        ASSERT_TRUE(end.succeeded()) << text_of("log");
    }
    ASSERT_EQ(aphotic("integrate gen").status, 0);
    EXPECT_EQ(signals("gen"), signals("out"));
}

// The frames serve other water, and say what they cannot do.
TEST_F(UserScenes, FramesOutliveTheRig) {
    put_scene(std::string(kFloor) +
              "sphere { <0, 0, 1.9>, 0.2 pigment { Aphotic_Pigment (\"red-algae\") } }\n");
    const std::string rig = read_text_file(home_ / "rig.toml");
    put("murky.toml", std::regex_replace(rig, std::regex("multiple   = 1.0"), "multiple = 1.1"));
    rendered("out", "--fitted 12");
    const CommandResult run = aphotic("integrate out --rig murky.toml --json");
    ASSERT_EQ(run.status, 0) << run.err;
    ASSERT_EQ(aphotic("render murky.toml --scene reef.pov -o murky").status, 0);
    const std::vector<float> integrated = signals("out/as-murky");
    const std::vector<float> direct = signals("murky");
    constexpr double kTwoTolerances = 2e-3;
    for (std::size_t i = 0; i < direct.size(); ++i) {
        ASSERT_NEAR(integrated[i], direct[i], kTwoTolerances * direct[i]) << i;
    }
}

// Where colours are numbers nobody knows how far the image is off: nothing says otherwise.
TEST_F(UserScenes, PromiseNothingOfColoursByNumbers) {
    put_scene(std::string(kFloor) + "sphere { <0, 0, 1.9>, 0.2 pigment { rgb <1, 0.5, 0> } }\n");
    const auto with = [&](const Arguments& words) {
        const CommandResult run = aphotic(words + "rig.toml --scene reef.pov --fitted 3");
        EXPECT_EQ(run.status, 0) << run.err;
        return run;
    };
    const CommandResult words = with("render -o out");
    EXPECT_TRUE(has(words.err, "reef.pov: no promise: numeric colours"));
    EXPECT_TRUE(has(words.out, "no bound on the error"));
    EXPECT_FALSE(has(words.out, "at most"));
    const CommandResult planned = with("plan");
    EXPECT_TRUE(has(planned.out, "no bound on the error"));
    EXPECT_FALSE(has(planned.out, "No pixel's signal"));

    const auto expect_none = [](const nlohmann::json& json) {
        EXPECT_TRUE(json.at("promise").is_null());
        EXPECT_EQ(json.at("no_promise").size(), 1U);
    };
    expect_none(nlohmann::json::parse(with("plan --json").out));
    expect_none(nlohmann::json::parse(with("render -o out --json").out));
    const CommandResult integrated = aphotic("integrate out --rig rig.toml --tolerance 0.9 --json");
    ASSERT_EQ(integrated.status, 0) << integrated.err;
    expect_none(nlohmann::json::parse(integrated.out));
    expect_none(
        nlohmann::json::parse(read_text_file(home_ / "out" / "as-rig" / "integration.json")));

    const auto manifest = nlohmann::json::parse(read_text_file(home_ / "out" / "manifest.json"));
    EXPECT_FALSE(manifest.contains("quality"));
    EXPECT_EQ(manifest.at("no_promise").size(), 1U);
    for (const char* image : {"image.exr", "spectral.exr", "as-rig/image.exr"}) {
        const std::string promise = ExrReader(home_ / "out" / image).attribute("aphotic:promise");
        EXPECT_TRUE(promise.starts_with("none: numeric colours")) << image << ": " << promise;
    }
    const CommandResult validated = aphotic("validate rig.toml --scene reef.pov -o check");
    EXPECT_EQ(validated.status, 2);
    EXPECT_TRUE(has(validated.err, "has no error bound to validate against"));
}

TEST_F(UserScenes, HaveAClockForAnimations) {
    const std::string ball = "sphere { <0, 0, 1.5>, 0.2 pigment { rgb 0.5 } }\n";
    const Arguments wavelengths("--wavelengths 470,550,620");
    put_scene(kFloor + ball);
    rendered("still", wavelengths);
    put_scene(std::string(kFloor) + "#if (clock > 0.5) " + ball + "#end\n");
    rendered("out", wavelengths);
    EXPECT_NE(signals("out"), signals("still"));
    EXPECT_EQ(rendered("out", "--clock 0.75 --wavelengths 470,550,620")["frames_kept"], 0);
    EXPECT_EQ(signals("out"), signals("still"));
    const CommandResult none = aphotic("plan rig.toml --clock 1");
    EXPECT_EQ(none.status, 2);
    EXPECT_TRUE(has(none.err, "--clock: found 1 without a scene"));
}

TEST_F(UserScenes, ThatReadWhatTheyWriteRenderOneAtATime) {
    put_scene(std::string(kFloor) +
              "#fopen Out \"ball.inc\" write\n#write (Out, \"sphere { <0, 0, 1.9>, \")\n"
              "#for (I, 0, 20000) #end\n#write (Out, \"0.1 pigment { rgb 0.5 } }\\n\")\n"
              "#fclose Out\n#include \"ball.inc\"\n");
    const auto made = rendered("out", "--fitted 6 --jobs 2");
    EXPECT_EQ(made["frames_rendered"], 2);
    EXPECT_EQ(made["jobs"], 1);
    EXPECT_GT(made["probe_s"], 0.0);
    EXPECT_EQ(rendered("out", "--fitted 6 --jobs 2")["frames_kept"], 2);
}

// POV-Ray cannot write there; a study is of what the reference knows.
TEST_F(UserScenes, AreRefusedWhereTheyCannotServe) {
    put_scene(kFloor);
    const CommandResult folder =
        aphotic({"render", "rig.toml", "--scene", "reef.pov", "-o", "\xC3\xBC", "--fitted", "1"});
    EXPECT_EQ(folder.status, 2);
    EXPECT_TRUE(has(folder.err, "letters beyond ASCII"));
    put("own.toml", "scene = \"reef.pov\"\n" + read_text_file(home_ / "rig.toml"));
    const CommandResult study = aphotic("study own.toml -o study");
    EXPECT_EQ(study.status, 2);
    EXPECT_TRUE(has(study.err, "own.toml: scene: found"));
    // Nor can it be given one beside the rig: what has no promise enters no study.
    const CommandResult option = aphotic("study rig.toml --scene reef.pov -o study");
    EXPECT_EQ(option.status, 2);
    EXPECT_TRUE(has(option.err, "--scene"));
    EXPECT_FALSE(fs::exists(home_ / "study"));
}

TEST_F(UserScenes, PassOnOnlyWhatChangesSpeed) {
    put_scene(kFloor);
    rendered("out", "--povray-ini Bounding_Method=2");
    EXPECT_NE(read_text_file(home_ / "out" / "povray" / "render.ini").find("Bounding_Method=2\n"),
              std::string::npos);
    for (const char* setting :
         {"Quality=8", "File_Gamma=2.2", "Bounding", "Bounding=on\nQuality=1"}) {
        const CommandResult run =
            aphotic("render rig.toml --scene reef.pov -o out" + Arguments{"--povray-ini", setting});
        EXPECT_EQ(run.status, 2) << setting;
        EXPECT_TRUE(has(run.err, "--povray-ini: found"));
    }
}

// Smooth light is the same however many rays; edges are not.
TEST_F(UserScenes, AntialiasingSmoothsEdgesAlone) {
    put_scene(kFloor);
    rendered("plain");
    rendered("smooth", "--antialias 3");
    const std::vector<float> plain = signals("plain");
    const std::vector<float> smooth = signals("smooth");
    constexpr double kSmoothLight = 5e-3;  // the light's own curvature over pixels of 25 mm
    std::size_t differ = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        differ += std::abs(smooth[i] / plain[i] - 1.0F) > kSmoothLight ? 1 : 0;
    }
    EXPECT_GT(differ, 0U);
    EXPECT_LT(differ, plain.size() / 2);
}

// --- Those that come with the project -----------------------------------------------------

class ShippedUserScenes : public testing::TestWithParam<fs::path> {};

TEST_P(ShippedUserScenes, RenderSmallAndInAQuickLook) {
    const TempFolder folder;
    const fs::path home = folder.path() / "scene";
    fs::copy(GetParam().parent_path(), home, fs::copy_options::recursive);
    const std::string rig = small_scene(GetParam());
    write_file(home / "rig.toml", rig);
    const CommandResult run = run_aphotic(home, "render rig.toml -o out --fitted 3 --json");
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_GT(nlohmann::json::parse(run.out)["signal"]["G"]["mean"], 0.0);

    std::smatch scene;
    ASSERT_TRUE(std::regex_search(rig, scene, std::regex(R"re(\nscene *= *"([^"]+)")re")));
    const ProcessEnd end = run_process(
        {.executable = find_povray("").executable,
         .arguments = {"+I" + scene[1].str(),
                       "+Oquick.png",
                       path_option("+L", std::string(APHOTIC_SOURCE_DIR) + "/plugin/include"),
                       "+W34",
                       "+H26",
                       "-D"},
         .folder = home,
         .environment = {},
         .log = folder.path() / "log"},
        120.0);
    EXPECT_TRUE(end.succeeded());
    EXPECT_EQ(read_text_file(folder.path() / "log").find("as grey"), std::string::npos)
        << "a quick look of ours knows all its spectra";
}

INSTANTIATE_TEST_SUITE_P(All,
                         ShippedUserScenes,
                         testing::ValuesIn(user_scenes()),
                         [](const auto& scene) { return scene.param.stem().string(); });
// Until there are some.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ShippedUserScenes);

}  // namespace
}  // namespace aphotic::scene_test
