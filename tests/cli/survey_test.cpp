// SPDX-License-Identifier: BSD-3-Clause
//
// `aphotic survey` of a flat floor, and what `aphotic correct` makes of it.
#include "base/degrees.h"
#include "image/exr.h"
#include "image/output_images.h"
#include "support/command_test.h"
#include "support/small_scene.h"
#include "survey/navigation/navigation_file.h"
#include "survey/simulate/flight.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace aphotic::survey_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kWidth_px = 8;  // of the scene's 340, forty times coarser

class SurveyCommand : public CommandTest {
  protected:
    SurveyCommand() { put_small_scene("survey/smooth.toml", home_); }
};

// The loop that the command is for: what was flown and what was seen, told apart by a correction
// that knows the rig. Of 16 bits without noise nothing is left but rounding.
TEST_F(SurveyCommand, IsCorrectedToItsTexture) {
    done("survey rig.toml --images 3 --white-level 65535 --no-noise -o out");
    done(
        "correct out/raw --rig rig.toml --nav out/navigation.txt --bayer RGGB --black-level 64 "
        "--white-level 65535 --keep-mosaic --middle 1 --format exr -o corrected");
    // The darkest pixel, red at the corner of the highest image, has some 100 numbers over black.
    constexpr double kRounding = 0.5 / 100.0;
    // The gain makes each channel's median 1: of its own pixels, whose textures differ.
    std::array<double, kChannels> level{};
    for (const char* name : {"000001.exr", "000002.exr", "000003.exr"}) {
        const std::vector<std::string> grey{"Y"};
        const std::vector<float> texture = ExrReader(path("out/texture") / name).planes(grey);
        const std::vector<float> result = ExrReader(path("corrected") / name).planes(grey);
        ASSERT_EQ(result.size(), texture.size());
        for (std::size_t i = 0; i < texture.size(); ++i) {
            const double ratio = result[i] / texture[i];
            double& of_channel = level.at(i % kWidth_px % 2 + i / kWidth_px % 2);  // RGGB
            if (of_channel == 0.0) of_channel = ratio;
            ASSERT_NEAR(ratio / of_channel, 1.0, 2.0 * kRounding) << name << ' ' << i;
        }
    }
}

TEST_F(SurveyCommand, EndsWithTheCommandThatCorrectsIt) {
    const std::string next = "Next:\n  aphotic ";
    const std::string out = done("survey rig.toml --images 3 -o out", next).out;
    const std::string command = out.substr(out.find(next) + next.size());
    EXPECT_TRUE(command.ends_with("-o out/corrected\n")) << command;
    done(Arguments(command.substr(0, command.size() - 1)), "3 images corrected");
    // It would have to repeat this setting.
    const std::string set = done("survey rig.toml --images 1 -o set --set water.multiple=2").out;
    EXPECT_EQ(set.find("Next:"), std::string::npos);
}

// A dive by its clock: the navigation knows no names, the images when they were taken.
TEST_F(SurveyCommand, CanBeCorrectedByTheTimeOfEachImage) {
    done("survey rig.toml --images 3 -o out");
    const Arguments common("--rig rig.toml --bayer RGGB --format exr -o");
    done(Arguments("correct out/raw --nav out/navigation-measured.txt") + common +
         Arguments("by-name"));
    done(Arguments("correct out/raw --nav out/navigation-timed.txt") + common +
         Arguments("by-time"));
    for (const char* name : {"000001.exr", "000002.exr", "000003.exr"}) {
        const std::vector<std::string> rgb{"R", "G", "B"};
        EXPECT_EQ(ExrReader(path("by-time") / name).planes(rgb),
                  ExrReader(path("by-name") / name).planes(rgb));
    }
}

TEST_F(SurveyCommand, FliesTheUsersNavigation) {
    write_file(path("dive.csv"),
               "image,altitude_m,pitch_deg,roll_deg\nB 1.jpg,2,1,0\nA.jpg,2.5,-1,3\n");
    const Arguments command("survey rig.toml --flight dive.csv -o out");
    done(command);
    EXPECT_EQ(text_of("out/navigation.txt"),
              "image,altitude_m,pitch_deg,roll_deg\n\"B 1.tif\",2,1,0\nA.tif,2.5,-1,3\n");
    EXPECT_TRUE(fs::exists(path("out/raw/B 1.tif")));
    EXPECT_TRUE(fs::exists(path("out/raw/A.tif")));
    done(command);  // the same again
    write_file(path("dive.csv"), "image,altitude_m,pitch_deg,roll_deg\nB.jpg,2,1,0\n");
    refused(command, "another");
}

// Asked for later, it is added, and nothing else changes.
TEST_F(SurveyCommand, AddsTheTruthThatIsAskedFor) {
    done("survey rig.toml --images 2 -o out");
    const auto before = files_in("out");
    done("survey rig.toml --images 2 --truth depth,reflectance --truth poses -o out");
    auto after = files_in("out");
    std::set<std::string> added;
    for (const auto& [name, bytes] : after) {
        if (!before.contains(name)) added.insert(name);
    }
    EXPECT_EQ(added,
              (std::set<std::string>{"colmap/cameras.txt",
                                     "colmap/images.txt",
                                     "colmap/points3D.txt",
                                     "depth/000001.exr",
                                     "depth/000002.exr",
                                     "reflectance/000001.exr",
                                     "reflectance/000002.exr"}));
    for (const auto& [name, bytes] : before) EXPECT_EQ(after[name], bytes) << name;
    // Of a floor of one colour: that times its texture.
    const std::vector<float> texture =
        ExrReader(path("out/texture/000002.exr")).planes(std::vector<std::string>{"Y"});
    const std::vector<float> green =
        ExrReader(path("out/reflectance/000002.exr")).planes(std::vector<std::string>{"G"});
    constexpr double kFloat = 4e-7;  // rounding, of a few operations
    for (std::size_t i = 0; i < texture.size(); ++i)
        ASSERT_NEAR(green[i] / texture[i], green[0] / texture[0], kFloat) << i;
}

TEST_F(SurveyCommand, RefusesTruthThatCannotBeHad) {
    refused("survey rig.toml --images 1 --truth ranges -o out", "--truth");
    write_file(path("mine.pov"), "#include \"aphotic.inc\"\nAphotic_Rig ()\n");
    refused(
        "survey rig.toml --images 1 --scene mine.pov --truth depth,normals -o out",
        "--truth: found normals of a POV-Ray scene of your own; allowed with one: depth, poses");
    write_file(path("dive.csv"), "image,altitude_m,pitch_deg,roll_deg\nB 1.jpg,2,1,0\n");
    refused("survey rig.toml --flight dive.csv --truth poses -o out",
            "rig.toml: found an image named 'B 1'; allowed for COLMAP: names without blanks");
}

TEST_F(SurveyCommand, TakesItsCameraFromTheRig) {
    std::string toml = text_of("rig.toml");
    toml.insert(toml.find("resolution"),
                "bayer = \"GBRG\"\nblack_level_dn = 10\nwhite_level_dn = 1023\n"
                "read_noise_e = 3\nsaturation_e = 5000\n");
    write_file(path("rig.toml"), toml);
    const Json camera =
        json_by("survey rig.toml --images 1 --read-noise-e 4 --json -o out").at("camera");
    EXPECT_EQ(camera["bayer"], "GBRG");
    EXPECT_EQ(camera["black_level_dn"], 10.0);
    EXPECT_DOUBLE_EQ(camera["gain_dn_per_e"], 1013.0 / 5000.0);
    EXPECT_EQ(camera["read_noise_e"], 4.0) << "the option's, over the rig's";

    // And so does the correction: levels, pattern and noise.
    toml.insert(toml.find("resolution"), "gain_dn_per_e = 0.2\n");
    write_file(path("rig.toml"), toml);
    done("correct out/raw --rig rig.toml --nav out/navigation-measured.txt -o corrected");
    const Json settings = json_in("corrected/correction.json").at("settings");
    EXPECT_EQ(settings["electrons"], 5.0);
    EXPECT_DOUBLE_EQ(settings["read_noise"], std::sqrt(0.36 + 1.0 / 12.0));
}

// A stop down is half the light, as the file's Exif tells, by which `correct` brings it back.
// EMVA 1288's numbers, and how many electrons a signal of 1 gives: raw is black + gain times these.
TEST_F(SurveyCommand, TakesItsCameraFromTheOptions) {
    const auto make = [&](const std::string& folder, const Arguments& more) {
        return json_by(fmt::format("survey rig.toml --images 1 --no-noise --json --texture 0 "
                                   "--white-level 65535 -o {}",
                                   folder) +
                       more)
            .at("camera");
    };
    // What the camera counted over black, by the command that averages it.
    const auto numbers = [&](const std::string& folder) {
        done(
            fmt::format("observe {0}/raw --nav {0}/navigation.txt --altitude 2 --within 9 "
                        "--bayer RGGB --black-level 64 -o {0}.exr",
                        folder));
        return ExrReader(path(folder + ".exr")).planes(std::array<std::string, 1>{"G"});
    };
    const Json camera = make("one", "--saturation-e 8000 --gain-dn-per-e 0.5");
    EXPECT_EQ(camera.at("saturation_e"), 8000.0);
    EXPECT_EQ(camera.at("gain_dn_per_e"), 0.5);
    const double electrons = camera.at("electrons_per_signal");
    make("half",
         {"--gain-dn-per-e", "0.5", "--electrons-per-signal", std::to_string(electrons / 2)});
    make("less", {"--gain-dn-per-e", "0.25", "--electrons-per-signal", std::to_string(electrons)});
    const std::vector<float> one = numbers("one");
    constexpr double kRounding = 0.05;  // of the darkest, some tens
    std::size_t told = 0;
    for (const char* folder : {"half", "less"}) {
        const std::vector<float> other = numbers(folder);
        ASSERT_EQ(other.size(), one.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            if (!std::isfinite(one[i])) continue;
            EXPECT_NEAR(other[i] / one[i], 0.5, 0.5 * kRounding) << folder;
            ++told;
        }
    }
    EXPECT_GE(told, one.size() / 2);  // every second site is green, of two images
}

TEST_F(SurveyCommand, ItsNavigationIsOffAsToldTo) {
    constexpr double kSixDigits = 2e-6;
    const auto poses = [&](const std::string& name) {
        std::vector<Sled> sleds;
        for (const Leg& leg : flight_of(read_navigation({.source = path(name)}, {}, nullptr)))
            sleds.push_back(leg.sled);
        return sleds;
    };
    Arguments command(
        "survey rig.toml --images 60 --no-noise --altitude-bias 0.2 --pitch-bias 1.5 --roll-bias "
        "-2.5 --altitude-error 0 --attitude-error 0 -o biased");
    done(command);
    const std::vector<Sled> flown = poses("biased/navigation.txt");
    const std::vector<Sled> told = poses("biased/navigation-measured.txt");
    ASSERT_EQ(told.size(), flown.size());
    for (std::size_t i = 0; i < flown.size(); ++i) {
        EXPECT_NEAR(told[i].altitude_m - flown[i].altitude_m, 0.2, kSixDigits);
        EXPECT_NEAR(told[i].pitch_rad - flown[i].pitch_rad, 1.5 * kRadiansPerDegree, kSixDigits);
        EXPECT_NEAR(told[i].roll_rad - flown[i].roll_rad, -2.5 * kRadiansPerDegree, kSixDigits);
    }

    command =
        "survey rig.toml --images 60 --no-noise --altitude-error 0.05 --attitude-error 2 -o random";
    done(command);
    const std::vector<Sled> scattered = poses("random/navigation-measured.txt");
    double altitude = 0.0;
    double pitch = 0.0;
    for (std::size_t i = 0; i < flown.size(); ++i) {
        altitude += std::pow(scattered[i].altitude_m - flown[i].altitude_m, 2.0) / 60.0;
        pitch +=
            std::pow((scattered[i].pitch_rad - flown[i].pitch_rad) / kRadiansPerDegree, 2.0) / 60.0;
    }
    constexpr double kOfSixty = 0.3;  // three standard errors of a deviation by sixty
    EXPECT_NEAR(std::sqrt(altitude) / 0.05, 1.0, kOfSixty);
    EXPECT_NEAR(std::sqrt(pitch) / 2.0, 1.0, kOfSixty);
}

TEST_F(SurveyCommand, TellsItsExposure) {
    std::string toml = text_of("rig.toml");
    toml.insert(toml.find("resolution"), "exposure_ms = 2.5\niso = 400\nf_number = 4\n");
    write_file(path("rig.toml"), toml);
    const auto electrons = [&](const std::string& folder, const Arguments& more) {
        return json_by(fmt::format(
                           "survey rig.toml --images 1 --no-noise --white-level 65535 --json -o {}",
                           folder) +
                       more)
            .at("camera")
            .at("electrons_per_signal")
            .get<double>();
    };
    const double as_set = electrons("set", {});
    EXPECT_DOUBLE_EQ(electrons("down", "--f-number 8"), as_set / 4.0);
    EXPECT_DOUBLE_EQ(electrons("long", "--exposure-ms 5"), as_set * 2.0);
    EXPECT_EQ(aphotic("survey rig.toml --images 1 --f-number 8 -o set").status, 2)
        << "another exposure's folder";

    const auto corrected = [&](const std::string& folder) {
        done(fmt::format(
            "correct {0}/raw --rig rig.toml --nav {0}/navigation.txt --white-level 65535 --bayer "
            "RGGB --black-level 64 --exposure exif --format exr -o {0}-corrected",
            folder));
        return read_signals(path(folder + "-corrected/000001.exr")).samples;
    };
    const std::vector<float> expected = corrected("set");
    for (const char* folder : {"down", "long"}) {
        const std::vector<float> found = corrected(folder);
        ASSERT_EQ(found.size(), expected.size());
        // Half a number of the hundred that the darkest pixel has.
        constexpr double kRounding = 5e-3;
        for (std::size_t i = 0; i < found.size(); ++i)
            ASSERT_NEAR(found[i], expected[i], kRounding * expected[i]) << folder << ' ' << i;
    }
}

TEST_F(SurveyCommand, RefusesWhatMakesNoSurvey) {
    for (const auto& [options, why] :
         Cases{{"--altitude 3,2", "the lower first"},
               {"--declare Depth=2", "found without a scene"},
               {"--declare Depth=2;", "NAME=NUMBER"},
               {"--bayer mono", "bayer: found mono"},
               {"--white-level 100000", "white_level_dn: found 100000"},
               {"--flight nowhere.csv", "nowhere.csv"},
               {"--f-number 0", "--f-number"},
               {"--flight rig.toml --images 3", "--images"}})
        refused("survey rig.toml -o out" + options, why);
}

// It looks for POV-Ray before it writes: the folder is not even made.
TEST_F(SurveyCommand, WithoutPovRayWritesNothing) {
    refused(
        "survey rig.toml --by-povray --povray nowhere/povray -o out", "nowhere/povray", kRunFailed);
}

}  // namespace
}  // namespace aphotic::survey_test
