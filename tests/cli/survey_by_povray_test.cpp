// SPDX-License-Identifier: BSD-3-Clause
//
// `aphotic survey` of what POV-Ray renders.
#include "image/output_images.h"
#include "support/has.h"
#include "support/small_scene.h"
#include "support/small_survey.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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

TEST(SurveyByPovray, IsWhatTheReferenceSeesOfTheBareCard) {
    const SmallSurvey survey;
    const CommandResult made = survey.make({"--images", "2", "--declare", "Survey_Floor=\"card\""});
    ASSERT_EQ(made.status, 0) << made.err;
    for (const Leg& leg : flight({}, 1, 2)) {
        const CommandResult trace =
            run_aphotic(survey.folder(), {"trace", survey.rig_at(leg).string(), "-o", leg.name});
        ASSERT_EQ(trace.status, 0) << trace.err;
        EXPECT_LT(off_reference(survey.folder() / "out/truth" / (leg.name + ".exr"),
                                survey.folder() / leg.name / "image.exr"),
                  kEdgePixels)
            << leg.name;
    }
}

// By lightmaps or by POV-Ray: a bare floor without texture is the same.
TEST(SurveyByPovray, OfABareFloorIsThatOfLightmaps) {
    const TempFolder folder;
    put_small_scene(fs::path(APHOTIC_SOURCE_DIR) / "scenes/survey/smooth.toml", folder.path());
    const auto make = [&](const std::string& name, const Arguments& more) {
        const CommandResult made =
            run_aphotic(folder.path(),
                        fmt::format("survey rig.toml --images 2 --texture 0 -o {}", name) + more);
        EXPECT_EQ(made.status, 0) << made.err;
    };
    make("maps", {});
    make("rendered", "--by-povray");
    for (const char* image : {"000001.exr", "000002.exr"}) {
        EXPECT_EQ(off_reference(folder.path() / "rendered/truth" / image,
                                folder.path() / "maps/truth" / image),
                  0U)
            << image;
    }
}

TEST(SurveyByPovray, GoesOnWhereItStoppedAndRefusesAnotherSurvey) {
    const SmallSurvey survey;
    const CommandResult made = survey.make("--images 1");
    ASSERT_EQ(made.status, 0) << made.err;
    const fs::path first = survey.folder() / "out/truth/000001.exr";
    const std::string bytes = read_text_file(first);
    const auto time = fs::last_write_time(first);
    fs::remove(survey.folder() / "out/raw/000001.tif");

    const CommandResult more = survey.make("--images 2");
    ASSERT_EQ(more.status, 0) << more.err;
    EXPECT_EQ(fs::last_write_time(first), time);
    EXPECT_TRUE(fs::exists(survey.folder() / "out/raw/000001.tif"));
    EXPECT_TRUE(fs::exists(survey.folder() / "out/raw/000002.tif"));
    EXPECT_EQ(read_text_file(survey.folder() / "out/navigation.txt"),
              navigation_text(flight({}, 1, 2), ".tif"));

    const CommandResult other = survey.make("--images 2 --seed 2");
    EXPECT_EQ(other.status, 2);
    EXPECT_TRUE(has(other.err, "another folder"));
    EXPECT_EQ(read_text_file(first), bytes);
}

// The rig's own floor and objects, in water that scatters, where POV-Ray tells how far pixels see.
TEST(SurveyByPovray, OfObjectsInMurkyWaterIsTheReferences) {
    const TempFolder folder;
    put_small_scene(fs::path(APHOTIC_SOURCE_DIR) / "scenes/objects.toml", folder.path());
    std::string toml = read_text_file(folder.path() / "rig.toml");
    toml = std::regex_replace(
        toml, std::regex("absorption *= [^\n]*\nmultiple *= [^\n]*"), "type = \"jerlov-IB\"");
    toml = std::regex_replace(toml, std::regex("400, 720"), "400, 700");
    toml = std::regex_replace(toml, std::regex("altitude_m *= [^\n]*"), "altitude_m = 2.25");
    toml = std::regex_replace(toml, std::regex("pitch_deg *= [^\n]*"), "pitch_deg = 3.0");
    toml = std::regex_replace(toml, std::regex("roll_deg *= [^\n]*"), "roll_deg = -2.0");
    write_file(folder.path() / "rig.toml", toml);
    write_file(folder.path() / "flown.csv",
               "image,altitude_m,pitch_deg,roll_deg\nthe only.jpg,2.25,3,-2\n");
    const CommandResult made =
        run_aphotic(folder.path(), "survey rig.toml --flight flown.csv --model-tolerance 1 -o out");
    ASSERT_EQ(made.status, 0) << made.err;
    const CommandResult trace =
        run_aphotic(folder.path(), "trace rig.toml --model-tolerance 1 -o reference");
    ASSERT_EQ(trace.status, 0) << trace.err;
    EXPECT_TRUE(fs::exists(folder.path() / "out/raw/the only.tif"));
    EXPECT_LT(off_reference(folder.path() / "out/truth/the only.exr",
                            folder.path() / "reference/image.exr"),
              kEdgePixels)
        << "beams' edges and the objects'";
}

TEST(SurveyByPovray, RefusesARigThatIsNotThereAndLeavesNothing) {
    const SmallSurvey survey;
    fs::remove(survey.rig());
    const CommandResult made = survey.make({});
    EXPECT_EQ(made.status, 2);
    EXPECT_TRUE(has(made.err, "survey.toml"));
    EXPECT_FALSE(fs::exists(survey.folder() / "out"));
}

}  // namespace
}  // namespace aphotic::survey_by_povray_test
