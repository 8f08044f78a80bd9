// SPDX-License-Identifier: BSD-3-Clause
//
// The correction of a survey as a program without our command calls it: poses of its own, and maps
// that no rig made.
#include "survey/correction_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/raw_survey.h"

#include <gtest/gtest.h>

namespace aphotic::correction_run_test {
namespace {

namespace fs = std::filesystem;

// The light of every image, but for its own factor: brighter by 1 / altitude than it was.
LightAt known_light() {
    const auto map_at = [](const Sled& sled) {
        Lightmap map{.width_px = RawSurvey::kWidth_px,
                     .height_px = RawSurvey::kHeight_px,
                     .samples = RawSurvey::light()};
        for (float& sample : map.samples) sample /= static_cast<float>(sled.altitude_m);
        return map;
    };
    return {.digest = "by hand",
            .camera_digest = "",
            .size = {RawSurvey::kWidth_px, RawSurvey::kHeight_px},
            .map = map_at,
            .edges =
                [](const Sled&, int) {
                    std::vector<std::uint8_t> edges(RawSurvey::kPixels_of_plane, 0);
                    edges[0] = 1;
                    return edges;
                },
            .map_as_radians = {},
            .floor_colour = std::nullopt};
}

class CorrectionRun : public testing::Test {
  protected:
    [[nodiscard]] CorrectionReport correct() const {
        Survey survey = raw_.survey();
        survey.light = known_light();
        return correct_survey(survey, options_, watch_);
    }

    RawSurvey raw_;
    CorrectionOptions options_{.run = {.folder = raw_.path("out"), .format = {.format = "exr"}}};
    RunWatch watch_;
};

// (raw - black) / map of the images is their factor times their altitude: 0.95, 2, 6.3 and 0.35.
// The median of four is the third in order, which comes out as a fifth.
TEST_F(CorrectionRun, DividesEachImageByTheLightOfItsPose) {
    constexpr double kFloats = 1e-6;
    const CorrectionReport report = correct();
    EXPECT_NEAR(report.gain.gain[1], 0.2 / 2.0, kFloats);
    EXPECT_EQ(report.gain.images.size(), 4U);
    EXPECT_EQ(report.run->corrected, 4U);
    EXPECT_NEAR(report.run->doubtful_share("edge"), 1.0 / RawSurvey::kPixels_of_plane, kFloats);
    for (const float sample : RawSurvey::samples_of(raw_.path("out/c.exr"), {"R", "G", "B"})) {
        EXPECT_NEAR(sample, 0.63, kFloats);
    }
}

TEST_F(CorrectionRun, ItsReportIsWhatItLeaves) {
    const nlohmann::ordered_json report = to_json(correct());
    EXPECT_EQ(nlohmann::ordered_json::parse(read_text_file(raw_.path("out/correction.json"))),
              report);
    EXPECT_EQ(report["corrected"], 4);
    EXPECT_EQ(report["settings"]["rig_sha256"], "by hand");
    EXPECT_EQ(report["doubtful"].size(), 5U);
    EXPECT_EQ(report["not_checked"],
              "altitudes, red for blue, radians: 4 images with light; needed: 12");
}

TEST_F(CorrectionRun, KeepsItsGainAndItsImages) {
    const CorrectionReport first = correct();
    raw_.write("b", 8.0F);
    const CorrectionReport again = correct();
    EXPECT_EQ(again.run->kept, 3U);
    EXPECT_EQ(again.run->corrected, 1U);
    EXPECT_EQ(again.gain.gain, first.gain.gain);
    EXPECT_EQ(again.settings_sha256, first.settings_sha256);
}

TEST_F(CorrectionRun, WhoRefusesWhatLooksWrongFindsNothingWritten) {
    watch_.looks_wrong = [](const auto&) { throw InputError("no"); };
    EXPECT_THROW(static_cast<void>(correct()), InputError);
    EXPECT_FALSE(fs::exists(raw_.path("out")));
}

TEST_F(CorrectionRun, TwoGainsAreRefused) {
    options_.gain = {1.0, 2.0};
    EXPECT_THROW(static_cast<void>(correct()), InputError);
    EXPECT_FALSE(fs::exists(raw_.path("out")));
}

}  // namespace
}  // namespace aphotic::correction_run_test
