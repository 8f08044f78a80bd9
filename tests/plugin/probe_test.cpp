// SPDX-License-Identifier: BSD-3-Clause
//
// What is learnt of a user's scene before it is planned, and the scenes that are refused.
#include "plugin/probe.h"

#include "base/error.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/scene_rig.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <regex>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

namespace aphotic::probe_test {
namespace {

// Half floats round the two channels whose ratio tells a path.
constexpr double kPathError = 2e-3;

Rig two_strobes() {
    Rig rig = habcam(68, 51);
    rig.strobes.erase(rig.strobes.begin() + 2, rig.strobes.end());  // POV-Ray runs once for each
    return rig;
}

class SceneProbe : public testing::Test {
  protected:
    UserScene probe(const std::string& scene, const Rig& rig = two_strobes()) {
        write_file(folder_.path() / "reef.pov",
                   "#version 3.7;\n#include \"aphotic.inc\"\n" + scene);
        return probe_scene(find_povray(""),
                           rig,
                           folder_.path() / "reef.pov",
                           {.jobs = 2,
                            .library_paths = {},
                            .progress = [this](double share) { shares_.push_back(share); },
                            .unchecked = unchecked_});
    }
    std::string refusal(const std::string& scene, const Rig& rig = two_strobes()) {
        return refusal_of([&] { static_cast<void>(probe(scene, rig)); });
    }
    void expect_refusal(const std::string& message, const std::string& part) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
    }

    TempFolder folder_;
    bool unchecked_ = false;
    std::vector<double> shares_;  // of the work, as they were reported
};

// The rig's own floor, whose paths its geometry tells: the probe's are these, with its room.
TEST_F(SceneProbe, MeasuresThePathsThatTheRigsOwnFloorHas) {
    const Rig rig = two_strobes();
    const UserScene scene = probe("Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n");
    const PathRange known = path_range(rig);
    // The corners' pixels lie half a pixel inside the image.
    constexpr double kHalfPixel = 0.01;
    EXPECT_NEAR(scene.paths.shortest_m * kProbeRoom / known.shortest_m, 1.0, kPathError);
    EXPECT_LE(scene.paths.longest_m / kProbeRoom, known.longest_m * (1.0 + kPathError));
    EXPECT_GE(scene.paths.longest_m / kProbeRoom, known.longest_m * (1.0 - kHalfPixel));
}

// One strobe at the camera and a plane that faces both: l = 2 d on the axis.
TEST_F(SceneProbe, MeasuresBrightnessAndPathInClosedForm) {
    Rig rig = two_strobes();
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    const UserScene scene = probe(
        "Aphotic_Camera (1, 0.01)\nAphotic_Water ()\n"
        "Aphotic_Cone (0, z, 90, 0.25, \"xenon-flash\", 3)\n"
        "plane { -z, -1.5 pigment { Aphotic_Pigment (\"sand\") } }\n",
        rig);
    ASSERT_EQ(scene.pixels.size(), 68U * 51U);
    const auto& middle = scene.pixels[68U * 25U + 34U];
    ASSERT_EQ(middle.size(), 1U);
    constexpr double kHalfFloatError = 6e-4;
    EXPECT_NEAR(middle[0].path_m / 3.0, 1.0, kPathError);
    EXPECT_NEAR(middle[0].radiance_per_flux / (3.0 * 0.25 / (std::numbers::pi * 1.5 * 1.5)),
                1.0,
                kHalfFloatError);
    // Phi G exp(-K l), everything white.
    const double nm = 550.0;
    EXPECT_NEAR(scene.brightest_radiance(rig, nm) /
                    (rig.strobes[0].spectrum.at(nm) * middle[0].radiance_per_flux *
                     std::exp(-rig.water.attenuation_per_m(nm) * 3.0)),
                1.0,
                5.0 * kPathError);
}

TEST_F(SceneProbe, FindsTheSpectraWhereverTheyAreAskedFor) {
    write_file(folder_.path() / "mud.csv", "wavelength_nm,reflectance\n380,0.1\n780,0.3\n");
    write_file(folder_.path() / "things.inc",
               "#macro Thing (Name) sphere { <0, 0, 1.9>, 0.1 pigment { Aphotic_Pigment (Name) } } "
               "#end\n");
    const UserScene scene = probe(
        "#include \"things.inc\"\nAphotic_Rig ()\nAphotic_Rig_Seafloor ()\n"
        "#for (I, 0, 1) Thing (concat(\"green\", \"-algae\")) #end\n"
        "#if (false) Thing (\"red-algae\") #end\n"
        "box { <0.2, 0.2, 1.9>, 2.1 pigment { granite pigment_map { "
        "[0 Aphotic_Pigment (\"mud.csv\")] [1 Aphotic_Pigment (\"sand\")] } } }\n");
    std::vector<std::string> names;
    for (const NamedSpectrum& material : scene.materials) names.push_back(material.name);
    EXPECT_EQ(names, (std::vector<std::string>{"green-algae", "mud.csv", "sand"}));
    EXPECT_EQ(scene.materials[1].spectrum.at(580.0), 0.2);
}

// What a mirror shows of the void is dark, and hides nothing of what it shows beside.
TEST_F(SceneProbe, AReflectionIntoTheVoidHidesNoPath) {
    const auto floor = [&](const std::string& finish) {
        return probe("Aphotic_Rig ()\n#declare Aphotic_Seafloor_Finish = finish { " + finish +
                     " }\nAphotic_Seafloor (2, 5, 0, \"sand\")\n");
    };
    const UserScene dull = floor("diffuse 1");
    const UserScene mirror = floor("diffuse 1 reflection 0.1");
    ASSERT_EQ(mirror.pixels.size(), dull.pixels.size());
    for (std::size_t i = 0; i < dull.pixels.size(); ++i) {
        ASSERT_EQ(mirror.pixels[i].size(), dull.pixels[i].size()) << i;
        for (std::size_t s = 0; s < dull.pixels[i].size(); ++s) {
            const auto& [radiance, path_m] = mirror.pixels[i][s];
            // Half floats tell a path from its loss alone half as well as from loss and gain.
            ASSERT_NEAR(path_m / dull.pixels[i][s].path_m, 1.0, 2.0 * kPathError) << i;
            ASSERT_NEAR(radiance / dull.pixels[i][s].radiance_per_flux, 1.0, kPathError) << i;
        }
    }
}

TEST_F(SceneProbe, AMirroringBallHidesNoPixel) {
    const auto lit = [&](const std::string& finish) {
        const UserScene scene = probe(
            "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\nsphere { <0, 0, 1.7>, 0.25 pigment { "
            "rgb 1 } finish { " +
            finish + " } }\n");
        std::vector<std::size_t> strobes;
        for (const auto& pixel : scene.pixels) strobes.push_back(pixel.size());
        return strobes;
    };
    // A strobe that lights no point of a pixel may yet be seen in the mirror.
    const std::vector<std::size_t> dull = lit("diffuse 1");
    const std::vector<std::size_t> mirror = lit("diffuse 1 reflection 0.2");
    for (std::size_t i = 0; i < dull.size(); ++i) ASSERT_GE(mirror[i], dull[i]) << i;
}

// Behind an endless way through the water.
TEST_F(SceneProbe, ASkyIsNotSeen) {
    const UserScene scene = probe(
        "Aphotic_Rig ()\nsky_sphere { pigment { rgb <0.2, 0.5, 1> } }\n"
        "box { <-0.3, -0.3, 1.9>, <0.2, 0.2, 2> pigment { rgb 0.5 } }\n");
    EXPECT_TRUE(scene.no_promise.empty());
    EXPECT_LT(scene.paths.longest_m, 5.0);
}

// A hand's breadth from camera and lamp, a fiftieth of the paths for which the probe sets out.
TEST_F(SceneProbe, MeasuresWhatIsNear) {
    Rig rig = two_strobes();
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    const UserScene scene = probe(
        "Aphotic_Camera (1, 0.01)\nAphotic_Water ()\n"
        "Aphotic_Cone (0, z, 90, 0.25, \"xenon-flash\", 1)\n"
        "plane { -z, -0.05 pigment { rgb 0.5 } }\n",
        rig);
    constexpr double kNearPathError = 0.016;  // half floats at a loss of 1/32
    EXPECT_NEAR(scene.paths.shortest_m * kProbeRoom / 0.1, 1.0, kNearPathError);
    EXPECT_NEAR(scene.paths.longest_m / kProbeRoom / 0.1, 1.0, kNearPathError);
}

// One run for what the scene is, one for what must not be, one a strobe.
TEST_F(SceneProbe, RunsPovrayOnceForEachAnswerAndTellsItsProgress) {
    static_cast<void>(probe("Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n"));
    EXPECT_EQ(shares_.size(), 2U + two_strobes().strobes.size());
    EXPECT_TRUE(std::ranges::is_sorted(shares_));
    EXPECT_EQ(shares_.back(), 1.0);
}

// As one that opens its file to write and is long about it: another would read the half of it.
constexpr const char* kWrites =
    "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n#fopen Out \"ball.inc\" write\n"
    "#write (Out, \"sphere { <0, 0, 1.9>, \")\n#for (I, 0, 20000) #end\n"
    "#write (Out, \"0.1 pigment { rgb 0.5 } }\\n\")\n#fclose Out\n#include \"ball.inc\"\n";

TEST_F(SceneProbe, OneThatReadsWhatItWritesIsLookedAtOneAtATime) {
    const UserScene first = probe(kWrites);
    EXPECT_TRUE(first.file.writes_files);
    EXPECT_EQ(probe(kWrites).digest, first.digest) << "also where the file is there already";
    EXPECT_FALSE(probe("Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n").file.writes_files);
}

TEST_F(SceneProbe, OneThatWritesSomethingElseEachTimeIsNamed) {
    EXPECT_TRUE(has(run_error_of([&] {
                        static_cast<void>(probe(
                            "#fopen Log \"log.txt\" append\n#write (Log, \"again\")\n#fclose Log\n"
                            "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n"));
                    }),
                    "Files that it writes itself must be the same"));
}

// --- Refusals --------------------------------------------------------------------------------

constexpr const char* kScene = "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n";

TEST_F(SceneProbe, RefusesLightsThatAreNotOurs) {
    expect_refusal(refusal(std::string(kScene) + "light_source { <0, 0, -9>, rgb 1 }\n"),
                   "reef.pov: found 1 light source that is not from aphotic.inc");
}

TEST_F(SceneProbe, RefusesASceneWithoutStrobes) {
    expect_refusal(refusal("Aphotic_Rig_Camera ()\nAphotic_Water ()\nAphotic_Rig_Seafloor ()\n"),
                   "found no strobe");
}

TEST_F(SceneProbe, RefusesASceneWithoutWater) {
    const std::string scene =
        "Aphotic_Rig_Camera ()\nAphotic_Rig_Strobes ()\nAphotic_Rig_Seafloor ()\n";
    expect_refusal(refusal(scene), "found no water");
    Rig clear = two_strobes();
    clear.water.multiple = 0.0;
    EXPECT_EQ(refusal(scene, clear), "nothing was said");
}

TEST_F(SceneProbe, RefusesASceneWithoutTheRigsPort) {
    Rig rig = two_strobes();
    rig.camera.port =
        PortWindow{.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
    EXPECT_EQ(refusal(kScene, rig), "nothing was said");
    expect_refusal(refusal("Aphotic_Camera (1, 1)\nAphotic_Water ()\nAphotic_Rig_Strobes ()\n"
                           "Aphotic_Rig_Seafloor ()\n",
                           rig),
                   "found no port, and the rig has one");
}

TEST_F(SceneProbe, RefusesALampThatTheRigDoesNotHave) {
    expect_refusal(refusal(std::string(kScene) + "Aphotic_Cone (0, z, 90, 1, \"xenon-arc\", 1)\n"),
                   "found the lamp \"xenon-arc\"; allowed: the spectra of the rig's strobes, "
                   "\"xenon-flash\"");
}

TEST_F(SceneProbe, RefusesASpectrumThatIsNotThere) {
    const std::string ball = "sphere { <0, 0, 1.9>, 0.1 pigment { Aphotic_Pigment (\"";
    expect_refusal(refusal(kScene + ball + "snad\") } }\n"),
                   "reef.pov: Aphotic_Pigment (\"snad\"): ");
    expect_refusal(refusal(kScene + ball + "rust.csv\") } }\n"), "rust.csv");
    write_file(folder_.path() / "short.csv", "wavelength_nm,reflectance\n500,0.1\n600,0.3\n");
    expect_refusal(refusal(kScene + ball + "short.csv\") } }\n"), "range_nm");
}

TEST_F(SceneProbe, RefusesASpectrumsNameThatIsMisspelt) {
    expect_refusal(
        refusal(std::string(kScene) +
                "sphere { <0, 0, 1.9>, 0.1 pigment { Aphotic_Pigment (\"green-alga\") } }\n"),
        "is not a known reflectance (did you mean \"green-algae\"?); allowed: brown-algae");
}

TEST_F(SceneProbe, RefusesMoreLightsThanPovrayTakesInWater) {
    expect_refusal(refusal(std::string(kScene) +
                           "#for (I, 1, 1019) Aphotic_Cone (<0, 0, -I / 1000>, z, 90, 1, "
                           "\"xenon-flash\", 1) #end\n"),
                   "found 1025 cones of light; allowed: 1024");
}

TEST_F(SceneProbe, RefusesANameThatPovrayCannotInclude) {
    for (const char* name : {"r\"eef.pov",
                             "r\\eef.pov",
                             "r\xC3\xA9"
                             "ef.pov"}) {
        write_file(folder_.path() / name, "#version 3.7;\n");
        EXPECT_THROW(static_cast<void>(probe_scene(find_povray(""),
                                                   two_strobes(),
                                                   folder_.path() / name,
                                                   {.jobs = 1, .library_paths = {}})),
                     InputError)
            << name;
    }
}

TEST_F(SceneProbe, RefusesAnotherCamera) {
    expect_refusal(refusal(std::string(kScene) + "camera { location <0, 0, 0> direction z }\n"),
                   "found a second camera");
    expect_refusal(refusal("Aphotic_Rig_Strobes ()\nAphotic_Water ()\nAphotic_Rig_Seafloor ()\n"
                           "camera { location <0, 0, 0> direction z }\n"),
                   "found no camera of aphotic.inc");
}

TEST_F(SceneProbe, RefusesLightThatNoStrobeGives) {
    expect_refusal(
        refusal(std::string(kScene) +
                "sphere { <0, 0, 1.9>, 0.1 finish { emission 0.01 } pigment { rgb 1 } }\n"),
        "found light with all strobes off");
    expect_refusal(
        refusal(std::string(kScene) + "light_group { light_source { <0, 0, 0>, rgb 1 } "
                                      "sphere { <0, 0, 1.9>, 0.1 pigment { rgb 1 } } }\n"),
        "found light with all strobes off");
}

TEST_F(SceneProbe, RefusesACameraInAnObjectWithoutWater) {
    expect_refusal(refusal(std::string(kScene) + "sphere { 0, 50 pigment { rgbt 1 } }\n"),
                   "found no water between the camera and what it sees");
    EXPECT_EQ(refusal(std::string(kScene) + "sphere { 0, 50 pigment { rgbt 1 } hollow }\n"),
              "nothing was said");
}

TEST_F(SceneProbe, ColoursByNumbersVoidThePromise) {
    EXPECT_TRUE(probe(kScene).no_promise.empty());
    EXPECT_TRUE(probe(std::string(kScene) + "sphere { <0, 0, 1.9>, 0.1 pigment { rgb 0.5 } }\n")
                    .no_promise.empty());
    EXPECT_EQ(
        probe(std::string(kScene) + "sphere { <0, 0, 1.9>, 0.1 pigment { rgb <1, 0.5, 0> } }\n")
            .no_promise.size(),
        1U);
}

// A disc 5 cm under a lamp, where all three channels are more than half floats hold.
TEST_F(SceneProbe, ColoursByNumbersVoidThePromiseWhereTheyAreBrightToo) {
    const auto reasons = [&](const std::string& colour) {
        return probe(std::string(kScene) +
                     "Aphotic_Cone (<0, 0, 1.9>, z, 80, 30000, \"xenon-flash\", 1)\n"
                     "disc { <0, 0, 1.95>, z, 0.1 pigment { rgb " +
                     colour + " } }\n")
            .no_promise.size();
    };
    EXPECT_EQ(reasons("<1, 0.5, 0.25>"), 1U);
    EXPECT_EQ(reasons("0.5"), 0U);
}

// Light whose error nothing bounds: refused, or rendered without a promise.
struct OwnLight {
    const char* what;
    const char* scene;

    friend std::ostream& operator<<(std::ostream& out, const OwnLight& light) {
        return out << light.what;
    }
};

class UnboundedLight : public SceneProbe, public testing::WithParamInterface<OwnLight> {};

TEST_P(UnboundedLight, IsRefusedOrVoidsThePromise) {
    const auto& [what, scene] = GetParam();
    expect_refusal(refusal(std::string(kScene) + scene),
                   "found " + std::string(what) + "; not supported: ");
    unchecked_ = true;
    const UserScene probed = probe(std::string(kScene) + scene);
    ASSERT_EQ(probed.no_promise.size(), 1U);
    EXPECT_TRUE(probed.no_promise[0].starts_with(what)) << probed.no_promise[0];
}

INSTANTIATE_TEST_SUITE_P(
    All,
    UnboundedLight,
    testing::Values(
        OwnLight{"radiosity",
                 "global_settings { radiosity { count 2 pretrace_start 1 pretrace_end 1 } }\n"
                 "sphere { <0, 0, 1.8>, 0.2 pigment { rgb 1 } }\n"},
        OwnLight{"photons",
                 "global_settings { photons { count 50 } }\n"
                 "sphere { <0, 0, 1.8>, 0.2 pigment { rgbt 1 } interior { ior 1.2 } hollow "
                 "photons { target refraction on } }\n"},
        OwnLight{"the scene's own media",
                 "sphere { <0, 0, 1.8>, 0.2 pigment { rgbt 1 } hollow interior { "
                 "media { samples 1 scattering { 1, 0.5 } } } }\n"}));

// Thirty times deeper than the rig's floor, and a lamp a hand's breadth over it: neither is lost.
TEST_F(SceneProbe, MeasuresWhatIsFarFromTheRigsOwnFloor) {
    const UserScene deep = probe(
        "Aphotic_Rig ()\n"
        "plane { -z, -60 pigment { Aphotic_Pigment (\"sand\") } }\n"
        "box { <0, -9, 1.9>, <9, 9, 2> pigment { Aphotic_Pigment (\"sand\") } }\n");
    EXPECT_GT(deep.paths.longest_m, 120.0);
    EXPECT_LT(deep.paths.shortest_m, 4.0);
    const UserScene bright = probe(
        "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n"
        "Aphotic_Cone (<0, 0, 1.9>, z, 89, 30000, \"xenon-flash\", 1)\n");
    double brightest = 0.0;
    for (const auto& pixel : bright.pixels) {
        for (const UserScene::Lit& lit : pixel) {
            brightest = std::max(brightest, lit.radiance_per_flux);
        }
    }
    // A / (pi d^2), a tenth of a metre under the lamp.
    constexpr double kTilt = 0.03;  // of a floor at 5 degrees, seen by pixels of 25 mm
    EXPECT_NEAR(brightest / (30000.0 / (std::numbers::pi * 0.01)), 1.0, kTilt);
}

TEST_F(SceneProbe, RefusesASceneOfWhichNothingIsLit) {
    expect_refusal(refusal("Aphotic_Rig ()\nsphere { <0, 0, -5>, 1 }\n"),
                   "found nothing in view that a strobe lights");
}

TEST_F(SceneProbe, ParseErrorsComeWithTheUsersFileAndLine) {
    expect_refusal(refusal(std::string(kScene) + "sphere { nonsense }\n"),
                   "File 'reef.pov' line 5: Parse Error");
    write_file(folder_.path() / "things.inc", "\n\nsphere { nonsense }\n");
    expect_refusal(refusal(std::string(kScene) + "#include \"things.inc\"\n"),
                   "File 'things.inc' line 3: Parse Error");
}

// The scratch folder is gone when the message is read.
TEST_F(SceneProbe, ErrorsNameNoFileThatIsGone) {
    const std::string twice = refusal(std::string(kScene) + "Aphotic_Water ()\n");
    expect_refusal(twice, "\nFile 'aphotic.inc' line ");
    const std::string open = refusal(std::string(kScene) + "#if (true)\n");
    expect_refusal(open, "\nAt the end of 'reef.pov': Parse Error: End of file reached");
    for (const std::string& message : {twice, open}) {
        EXPECT_EQ(message.find('/', message.find('\n')), std::string::npos) << message;
    }
}

TEST_F(SceneProbe, RefusesLightUnderNought) {
    expect_refusal(
        refusal(std::string(kScene) + "sphere { <0, 0, 1.8>, 0.2 pigment { rgb -0.5 } }\n"),
        "allowed: 0 or more. Is there a colour below 0?");
}

// The camera looks out of a block without water, in which a lamp lights a part of the floor.
TEST_F(SceneProbe, RefusesWhatNoWaterDimsInAPartOfTheImage) {
    const std::string dry = std::string(kScene) +
                            "box { <-0.3, -0.3, -1>, <0.3, 0.3, 2.5> pigment { rgbt 1 } }\n"
                            "Aphotic_Cone (0, z, 60, 1, \"xenon-flash\", 1)\n";
    expect_refusal(refusal(dry), "found light that passes through no water, in ");
    // Where the promise is void by another fault, this one is named too.
    const std::vector<std::string> reasons =
        probe(dry + "sphere { <0.6, 0, 1.9>, 0.1 pigment { rgb <1, 0.5, 0> } }\n").no_promise;
    ASSERT_EQ(reasons.size(), 2U);
    std::smatch counts;
    ASSERT_TRUE(std::regex_match(
        reasons[1],
        counts,
        std::regex(R"(light that passes through no water, in (\d+) of (\d+) pixels)")))
        << reasons[1];
    // The block is square, 0.6 m wide, and no farther than the floor at 2 m: each pixel counts
    // once, however many strobes shine on it.
    EXPECT_GT(std::stoi(counts[1]), 0);
    EXPECT_LT(std::stoi(counts[1]), std::stoi(counts[2]) / 2);
}

TEST_F(SceneProbe, LeavesTheUsersFolderAsItWas) {
    static_cast<void>(probe(kScene));
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
        names.push_back(entry.path().filename().string());
    }
    EXPECT_EQ(names, std::vector<std::string>{"reef.pov"});
}

}  // namespace
}  // namespace aphotic::probe_test
