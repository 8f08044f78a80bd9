// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes of the user's own through the command, from a folder with a blank in its name.
#include "image/exr.h"
#include "image/output_images.h"
#include "plugin/povray.h"
#include "spectral/manifest.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

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
    UserScenes() : CommandTest("my scenes") { put("rig.toml", small_scene("habcam.toml")); }
    void put(const std::string& name, const std::string& text) { write_file(path(name), text); }
    void put_scene(const std::string& text, const std::string& name = "reef.pov") {
        put(name, "#version 3.7;\n#include \"aphotic.inc\"\n" + text);
    }
    nlohmann::json rendered(const std::string& folder, const Arguments& more = {}) {
        return json_by("render rig.toml --scene reef.pov --json -o " + folder + more);
    }
    [[nodiscard]] std::vector<float> signals(const std::string& folder) const {
        return read_signals(path(folder + "/image.exr")).samples;
    }
};

TEST_F(UserScenes, ValidateLikeAnyOther) {
    put_scene(kFloor);
    done("validate rig.toml --scene reef.pov -o out");
    const std::string page = text_of("out/report.html");
    EXPECT_TRUE(has(page, "reef.pov\u2069, a scene of the user’s own"))
        << "the page says what the reference did not read";
    const auto json = json_in("out/validation.json");
    EXPECT_TRUE(json.at("rig").at("scene").get<std::string>().ends_with("reef.pov"));
    // A floor that is farther than the rig says must not pass.
    put_scene("Aphotic_Rig ()\nAphotic_Seafloor (2.05, 5, 0, \"sand\")\n");
    done("validate rig.toml --scene reef.pov -o out", "", kAnswerIsNo);
}

// Up to where what the scene shows stands.
TEST_F(UserScenes, HaveTheVeilOfWaterThatScatters) {
    put("rig.toml",
        replaced(with(text_of("rig.toml"), {{"range_nm", "[400, 700]"}}),
                 "absorption = \"pope-fry-1997\"",
                 "type = \"jerlov-1C\"\n"
                 "phase = { fournier_forand = { backscatter_ratio = 0.0135 } }"));
    put_scene(kFloor);
    const Arguments validate("validate rig.toml --scene reef.pov -o out --model-tolerance 1");
    done(validate);
    // A floor that stands nearer has less before it, and the reference's has not.
    put_scene("Aphotic_Rig ()\nAphotic_Seafloor (1.95, 5, 0, \"sand\")\n");
    done(validate, "", kAnswerIsNo);
}

TEST_F(UserScenes, ARigMayNameItsScene) {
    put_scene(kFloor);
    const std::string rig = text_of("rig.toml");
    put("rig.toml", "scene = \"reef.pov\"\n" + rig);
    done("plan rig.toml", "reef.pov uses sand");
    // The reference knows no scene, and needs no POV-Ray.
    done(aphotic("trace rig.toml -o t", {{"APHOTIC_POVRAY", "none"}}));
}

TEST_F(UserScenes, AreRenderedAgainWhenWhatTheyIncludeChanges) {
    put("things.inc", "#declare Size = 0.1;\n");
    put_scene(std::string(kFloor) +
              "#include \"things.inc\"\n"
              "sphere { <0, 0, 1.9>, Size pigment { Aphotic_Pigment (\"red-algae\") } }\n");
    const std::string scene = text_of("reef.pov");
    const auto first = rendered("out");
    EXPECT_GT(first["frames_rendered"], 0);
    const std::vector<float> small = signals("out");
    EXPECT_EQ(rendered("out")["frames_rendered"], 0);
    EXPECT_EQ(signals("out"), small);
    put("things.inc", "#declare Size = 0.2;\n");
    EXPECT_EQ(rendered("out")["frames_kept"], 0);
    EXPECT_NE(signals("out"), small);
    EXPECT_EQ(text_of("reef.pov"), scene) << "scenes are never modified";
}

// What plain povray renders from `generate` is what `render` renders.
TEST_F(UserScenes, GeneratedFramesRenderInPlainPovray) {
    put_scene(std::string(kFloor) +
              "#include \"colors.inc\"\n"
              "sphere { <0, 0, 1.9>, 0.2 pigment { Aphotic_Pigment (\"red-algae\") } }\n");
    rendered("out");
    done("generate rig.toml --scene reef.pov -o gen");
    for (const ManifestFrame& frame : read_manifest(path("gen")).frames) {
        const ProcessEnd end = by(find_povray("").executable,
                                  "gen/povray/render.ini +Igen/povray/" + frame.name + ".pov");
        ASSERT_TRUE(end.succeeded()) << text_of("log");
    }
    done("integrate gen");
    EXPECT_EQ(signals("gen"), signals("out"));
}

// The frames serve other water, and say what they cannot do.
TEST_F(UserScenes, FramesOutliveTheRig) {
    put_scene(std::string(kFloor) +
              "sphere { <0, 0, 1.9>, 0.2 pigment { Aphotic_Pigment (\"red-algae\") } }\n");
    put("murky.toml", with(text_of("rig.toml"), {{"multiple", "1.1"}}));
    rendered("out", "--fitted 12");
    done("integrate out --rig murky.toml --json");
    done("render murky.toml --scene reef.pov -o murky");
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
        return done(words + "rig.toml --scene reef.pov --fitted 3");
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
    expect_none(json_by(with("plan --json")));
    expect_none(json_by(with("render -o out --json")));
    expect_none(json_by("integrate out --rig rig.toml --tolerance 0.9 --json"));
    expect_none(json_in("out/as-rig/integration.json"));

    const auto manifest = json_in("out/manifest.json");
    EXPECT_FALSE(manifest.contains("quality"));
    EXPECT_EQ(manifest.at("no_promise").size(), 1U);
    for (const char* image : {"image.exr", "spectral.exr", "as-rig/image.exr"}) {
        const std::string promise =
            ExrReader(path(std::string("out/") + image)).attribute("aphotic:promise");
        EXPECT_TRUE(promise.starts_with("none: numeric colours")) << image << ": " << promise;
    }
    refused("validate rig.toml --scene reef.pov -o check",
            "has no error bound to validate against");
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
    refused("plan rig.toml --clock 1", "--clock: found 1 without a scene");
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
    refused({"render", "rig.toml", "--scene", "reef.pov", "-o", "\xC3\xBC", "--fitted", "1"},
            "non-ASCII letters");
    put("own.toml", "scene = \"reef.pov\"\n" + text_of("rig.toml"));
    refused("study own.toml -o study", "own.toml: scene: found");
    // Nor can it be given one beside the rig: what has no promise enters no study.
    refused("study rig.toml --scene reef.pov -o study", "--scene");
    EXPECT_FALSE(fs::exists(path("study")));
}

TEST_F(UserScenes, PassOnOnlyWhatChangesSpeed) {
    put_scene(kFloor);
    rendered("out", "--povray-ini Bounding_Method=2");
    EXPECT_TRUE(has(text_of("out/povray/render.ini"), "Bounding_Method=2\n"));
    for (const char* setting :
         {"Quality=8", "File_Gamma=2.2", "Bounding", "Bounding=on\nQuality=1"}) {
        refused("render rig.toml --scene reef.pov -o out" + Arguments{"--povray-ini", setting},
                "--povray-ini: found");
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

class ShippedUserScenes : public CommandTest, public testing::WithParamInterface<fs::path> {
  protected:
    ShippedUserScenes() : CommandTest("scene") {}
};

TEST_P(ShippedUserScenes, RenderSmallAndInAQuickLook) {
    fs::copy(GetParam().parent_path(), home_, fs::copy_options::recursive);
    const std::string rig = small_scene(GetParam());
    write_file(path("rig.toml"), rig);
    EXPECT_GT(json_by("render rig.toml -o out --fitted 3 --json")["signal"]["G"]["mean"], 0.0);

    std::smatch scene;
    ASSERT_TRUE(std::regex_search(rig, scene, std::regex(R"re(\nscene *= *"([^"]+)")re")));
    const ProcessEnd end =
        by(find_povray("").executable,
           "+Oquick.png +W34 +H26 -D" +
               Arguments{"+I" + scene[1].str(),
                         path_option("+L", std::string(APHOTIC_SOURCE_DIR) + "/plugin/include")});
    EXPECT_TRUE(end.succeeded());
    EXPECT_FALSE(has(text_of("log"), "as grey")) << "a quick look of ours knows all its spectra";
}

INSTANTIATE_TEST_SUITE_P(All,
                         ShippedUserScenes,
                         testing::ValuesIn(user_scenes()),
                         [](const auto& scene) { return scene.param.stem().string(); });
// Until there are some.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ShippedUserScenes);

}  // namespace
}  // namespace aphotic::scene_test
