// SPDX-License-Identifier: BSD-3-Clause
//
// The core of docs/lightmaps.md, Proof, with half as many pixels a side: what POV-Ray rendered,
// divided by the lightmap of each image's own altitude and attitude.
#include "bench/survey/chart.h"
#include "support/run_command.h"
#include "support/small_survey.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace aphotic::survey {
namespace {

constexpr int kImages = 4;

// What is asked of a correction without noise.
constexpr double kFlat = 0.01;
// The plan's promise for grey, twice, for a ratio of two channels; and what a tile's height of 0.2
// mm and its frames' half floats add.
constexpr double kOneColour = 2.5e-3;

class Proof : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        survey_ = std::make_unique<SmallSurvey>();
        ASSERT_EQ(survey_->make({"--images", std::to_string(kImages)}), 0) << survey_->said();
    }
    static void TearDownTestSuite() { survey_.reset(); }

    static CameraImage truth(const Leg& leg) { return read_signals(file("truth", leg)); }
    static std::vector<Tile> chart(const Leg& leg) {
        return find_chart(truth(leg), read_signals(file("card", leg)));
    }
    static std::filesystem::path file(const char* folder, const Leg& leg) {
        return survey_->folder() / "out" / folder / (leg.name + ".exr");
    }

    // What `aphotic correct` makes of a folder of the survey.
    static SurveyScore corrected(const char* folder, std::vector<std::string> options) {
        const std::string result = std::string("corrected-") + folder;
        options.insert(options.begin(),
                       {"correct", std::string("out/") + folder, "--rig", survey_->rig().string()});
        options.insert(options.end(),
                       {"--nav", "out/navigation.txt", "--format", "exr", "-o", result});
        const CommandResult run = run_aphotic(survey_->folder(), options);
        EXPECT_EQ(run.status, 0) << run.err;
        return scored(survey_->folder() / result);
    }
    static SurveyScore scored(const std::filesystem::path& folder) {
        std::vector<ChartScore> scores;
        for (const Leg& leg : flight(1, kImages)) {
            scores.push_back(score_chart(read_signals(folder / (leg.name + ".exr")), chart(leg)));
            constexpr std::size_t kEnoughPixels = 400;  // to speak of a chart, of 170 x 128
            EXPECT_GT(scores.back().pixels, kEnoughPixels);
        }
        return summed_up(scores);
    }

    static inline std::unique_ptr<SmallSurvey> survey_;
};

TEST_F(Proof, TheChartIsFlatAndOfOneColourOverAltitude) {
    const SurveyScore after = corrected("truth", {});
    EXPECT_LT(after.worst_unevenness, kFlat);
    EXPECT_NEAR(after.tone, 1.0, kOneColour);
    EXPECT_LT(after.colour_spread, kOneColour);
    EXPECT_LT(after.level_spread, kOneColour);
    // What there was to correct: a test on even light would prove nothing.
    const SurveyScore before = scored(survey_->folder() / "out/truth");
    EXPECT_GT(before.unevenness, 10.0 * kFlat);
    EXPECT_GT(before.level_spread, 10.0 * kFlat);
}

// 12 bits under RGGB filters, with noise: pixels differ by it, the tiles' means do not.
TEST_F(Proof, RawImagesKeepTonesAndOneColour) {
    const SurveyScore after = corrected("raw",
                                        {"--bayer",
                                         "RGGB",
                                         "--black-level",
                                         "64",
                                         "--white-level",
                                         "4095",
                                         "--read-noise",
                                         "2.15",
                                         "--electrons",
                                         "3.72",
                                         "--most-noise",
                                         "0.5"});
    // A pixel's noise is up to 0.2 of it, in the worst channel of the worst image. Of the 200
    // pixels and more of a kind of tile demosaicing leaves one in four independent: four standard
    // deviations of their mean.
    constexpr double kNoiseOfMeans = 0.12;
    EXPECT_NEAR(after.tone, 1.0, kNoiseOfMeans);
    EXPECT_LT(after.colour_spread, kNoiseOfMeans);
    EXPECT_LT(after.level_spread, kNoiseOfMeans);
}

}  // namespace
}  // namespace aphotic::survey
