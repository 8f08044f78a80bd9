// SPDX-License-Identifier: BSD-3-Clause
//
// The program `survey`.
#include "bench/survey/flight.h"
#include "bench/survey/image_file.h"
#include "image/exr.h"
#include "support/run_command.h"
#include "support/small_survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace aphotic::survey::make_survey_test {
namespace {

namespace fs = std::filesystem;

TEST(MakeSurvey, IsWhatTheReferenceSeesOfTheBareCard) {
    const SmallSurvey survey;
    ASSERT_EQ(survey.make({"--images", "2"}), 0) << survey.said();
    // The plan's promise, 9.6e-4, and the last digit of a frame's half float.
    constexpr double kPromise = 1.5e-3;
    for (const Leg& leg : flight(1, 2)) {
        const CommandResult trace =
            run_aphotic(survey.folder(), {"trace", survey.rig_at(leg).string(), "-o", leg.name});
        ASSERT_EQ(trace.status, 0) << trace.err;
        const CameraImage expected = read_signals(survey.folder() / leg.name / "image.exr");
        const CameraImage card = read_signals(survey.folder() / "out/card" / (leg.name + ".exr"));
        ASSERT_EQ(card.samples.size(), expected.samples.size());
        // The edge of a cone may fall to either side of a pixel's centre.
        constexpr std::size_t kEdgePixels = 20;
        std::size_t off = 0;
        for (std::size_t i = 0; i < card.samples.size(); ++i) {
            if (std::abs(card.samples[i] / expected.samples[i] - 1.0) > kPromise) ++off;
        }
        EXPECT_LT(off, kEdgePixels) << leg.name;
    }
}

TEST(MakeSurvey, GoesOnWhereItStoppedAndRefusesAnotherSurvey) {
    const SmallSurvey survey;
    ASSERT_EQ(survey.make({"--images", "1"}), 0) << survey.said();
    const fs::path first = survey.folder() / "out/truth/000001.exr";
    const std::string bytes = read_text_file(first);
    const auto made = fs::last_write_time(first);
    fs::remove(survey.folder() / "out/raw/000001.tif");

    ASSERT_EQ(survey.make({"--images", "2"}), 0) << survey.said();
    EXPECT_EQ(fs::last_write_time(first), made);
    EXPECT_TRUE(fs::exists(survey.folder() / "out/raw/000001.tif"));
    EXPECT_TRUE(fs::exists(survey.folder() / "out/raw/000002.tif"));
    EXPECT_EQ(read_text_file(survey.folder() / "out/navigation.txt"),
              navigation(flight(1, 2), ".tif"));

    EXPECT_EQ(survey.make({"--images", "2", "--seed", "2"}), 2);
    EXPECT_NE(survey.said().find("another folder"), std::string::npos) << survey.said();
    EXPECT_EQ(read_text_file(first), bytes);
}

TEST(MakeSurvey, RefusesARigThatIsNotThereAndLeavesNothing) {
    const SmallSurvey survey;
    fs::remove(survey.rig());
    EXPECT_EQ(survey.make({}), 2);
    EXPECT_NE(survey.said().find("survey.toml"), std::string::npos) << survey.said();
    EXPECT_FALSE(fs::exists(survey.folder() / "out"));
}

}  // namespace
}  // namespace aphotic::survey::make_survey_test
