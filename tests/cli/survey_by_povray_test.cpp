// SPDX-License-Identifier: BSD-3-Clause
//
// `aphotic survey` of what POV-Ray renders.
#include "image/exr.h"
#include "image/output_images.h"
#include "support/command_test.h"
#include "support/scene_text.h"
#include "support/small_scene.h"
#include "support/small_survey.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::survey_by_povray_test {
namespace {

namespace fs = std::filesystem;

// The plan's promise, 9.6e-4, and the last digit of a frame's half float.
constexpr double kPromise = 1.5e-3;

// How many samples are off the reference's by more than that: of an image, the edge of a beam may
// fall to either side of a pixel's centre.
std::size_t off_reference(const fs::path& image, const fs::path& reference) {
    const CameraImage made = read_signals(image);
    const CameraImage expected = read_signals(reference);
    std::size_t off = made.samples.size() == expected.samples.size() ? 0 : expected.samples.size();
    for (std::size_t i = 0; i < expected.samples.size() && off < expected.samples.size(); ++i) {
        if (!(std::abs(made.samples[i] / expected.samples[i] - 1.0) <= kPromise)) ++off;
    }
    return off;
}
constexpr std::size_t kEdgePixels = 20;

using SurveyByPovray = CommandTest;

TEST_F(SurveyByPovray, IsWhatTheReferenceSeesOfTheBareCard) {
    const SmallSurvey survey;
    done(survey.make("--images 2 --declare Survey_Floor=\"card\""));
    for (const Leg& leg : flight({}, 1, 2)) {
        done(run_aphotic(survey.folder(), {"trace", survey.rig_at(leg).string(), "-o", leg.name}));
        EXPECT_LT(off_reference(survey.folder() / "out/truth" / (leg.name + ".exr"),
                                survey.folder() / leg.name / "image.exr"),
                  kEdgePixels)
            << leg.name;
    }
}

// By lightmaps or by POV-Ray: a bare floor without texture is the same.
TEST_F(SurveyByPovray, OfABareFloorIsThatOfLightmaps) {
    put_small_scene("survey/smooth.toml", home_);
    done("survey rig.toml --images 2 --texture 0 -o maps");
    done("survey rig.toml --images 2 --texture 0 -o rendered --by-povray");
    for (const char* image : {"000001.exr", "000002.exr"}) {
        EXPECT_EQ(off_reference(path("rendered/truth") / image, path("maps/truth") / image), 0U)
            << image;
    }
}

TEST_F(SurveyByPovray, GoesOnWhereItStoppedAndRefusesAnotherSurvey) {
    const SmallSurvey survey;
    done(survey.make("--images 1"));
    const fs::path first = survey.folder() / "out/truth/000001.exr";
    const std::string bytes = read_text_file(first);
    const auto time = fs::last_write_time(first);
    fs::remove(survey.folder() / "out/raw/000001.tif");

    done(survey.make("--images 2"));
    EXPECT_EQ(fs::last_write_time(first), time);
    EXPECT_TRUE(fs::exists(survey.folder() / "out/raw/000001.tif"));
    EXPECT_TRUE(fs::exists(survey.folder() / "out/raw/000002.tif"));
    EXPECT_EQ(read_text_file(survey.folder() / "out/navigation.txt"),
              navigation_text(flight({}, 1, 2), ".tif"));

    refused(survey.make("--images 2 --seed 2"), "another folder");
    EXPECT_EQ(read_text_file(first), bytes);
}

// Of a scene that is there already, too, at the pose and with the declarations of each image. The
// card is a plane: its axis meets it at the altitude, and its depths are those of the flat floor.
TEST_F(SurveyByPovray, TellsTheRangesOfAScene) {
    const SmallSurvey survey;
    done(survey.make("--images 2 --declare Survey_Floor=\"card\""));
    done(survey.make("--images 2 --declare Survey_Floor=\"card\" --truth depth,poses"));
    done(run_aphotic(
        survey.folder(),
        {"survey", survey.rig().string(), "--images", "2", "-o", "flat", "--truth", "depth"}));
    // Of the altitude, up to one and a half: 2^-17 exp(3/2), and floats' rounding.
    constexpr double kPng = 0x1p-17 * 4.6;
    for (const Leg& leg : flight({}, 1, 2)) {
        const auto ranges = [&](const fs::path& folder) {
            return ExrReader(survey.folder() / folder / "depth" / (leg.name + ".exr"))
                .planes(std::vector<std::string>{"Z"});
        };
        const std::vector<float> scene = ranges("out");
        const std::vector<float> flat = ranges("flat");
        ASSERT_EQ(scene.size(), flat.size());
        for (std::size_t i = 0; i < flat.size(); ++i)
            ASSERT_NEAR(scene[i], flat[i], kPng * leg.sled.altitude_m) << leg.name << ' ' << i;
    }
    EXPECT_TRUE(fs::exists(survey.folder() / "out/colmap/images.txt"));
}

// The rig's own floor and objects, in water that scatters, where POV-Ray tells how far pixels see.
TEST_F(SurveyByPovray, OfObjectsInMurkyWaterIsTheReferences) {
    put_small_scene("objects.toml", home_);
    const std::string toml =
        std::regex_replace(text_of("rig.toml"),
                           std::regex("absorption *= [^\n]*\nmultiple *= [^\n]*"),
                           "type = \"jerlov-IB\"");
    write_file(path("rig.toml"),
               with(toml,
                    {{"range_nm", "[400, 700]"},
                     {"altitude_m", "2.25"},
                     {"pitch_deg", "3.0"},
                     {"roll_deg", "-2.0"}}));
    write_file(path("flown.csv"), "image,altitude_m,pitch_deg,roll_deg\nthe only.jpg,2.25,3,-2\n");
    done("survey rig.toml --flight flown.csv --model-tolerance 1 -o out");
    done("trace rig.toml --model-tolerance 1 -o reference");
    EXPECT_TRUE(fs::exists(path("out/raw/the only.tif")));
    EXPECT_LT(off_reference(path("out/truth/the only.exr"), path("reference/image.exr")),
              kEdgePixels)
        << "beams' edges and the objects'";
}

TEST_F(SurveyByPovray, RefusesARigThatIsNotThereAndLeavesNothing) {
    const SmallSurvey survey;
    fs::remove(survey.rig());
    refused(survey.make({}), "survey.toml");
    EXPECT_FALSE(fs::exists(survey.folder() / "out"));
}

}  // namespace
}  // namespace aphotic::survey_by_povray_test
