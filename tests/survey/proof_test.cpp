// SPDX-License-Identifier: BSD-3-Clause
//
// The core of docs/lightmaps.md, Proof, with half as many pixels a side: what POV-Ray rendered,
// divided by the lightmap of each image's own altitude and attitude.
#include "bench/survey/chart.h"
#include "bench/survey/image_file.h"
#include "lightmap/lightmap.h"
#include "scene_gen/rig_reader.h"
#include "support/run_command.h"
#include "support/small_survey.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

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

    static inline std::unique_ptr<SmallSurvey> survey_;
};

Sled sled_of(const Leg& leg) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    return {.altitude_m = leg.altitude_m,
            .pitch_rad = leg.pitch_deg * kDegree,
            .roll_rad = leg.roll_deg * kDegree};
}

TEST_F(Proof, TheChartIsFlatAndOfOneColourOverAltitude) {
    const Rig rig = read_rig(survey_->rig());
    std::vector<Sled> sleds;
    for (const Leg& leg : flight(1, kImages)) sleds.push_back(sled_of(leg));
    const LightmapMaker maker(rig, paths_of(rig, sleds), {});

    std::vector<ChartScore> raw;
    std::vector<ChartScore> corrected;
    for (const Leg& leg : flight(1, kImages)) {
        const std::vector<Tile> tiles = chart(leg);
        CameraImage image = truth(leg);
        raw.push_back(score_chart(image, tiles));
        const Lightmap map = maker.map(sled_of(leg));
        for (std::size_t i = 0; i < image.samples.size(); ++i) image.samples[i] /= map.samples[i];
        corrected.push_back(score_chart(image, tiles));

        constexpr std::size_t kEnoughPixels = 100;  // to speak of a chart, of 170 x 128
        EXPECT_GT(corrected.back().pixels, kEnoughPixels);
        // The card has 0.18 and a light tile 2.5 times that, so the map's own floor gives 2.5.
        for (const double light : corrected.back().light) EXPECT_NEAR(light, 2.5, 2.5 * kFlat);
    }
    const SurveyScore before = summed_up(raw);
    const SurveyScore after = summed_up(corrected);
    EXPECT_LT(after.worst_unevenness, kFlat);
    EXPECT_NEAR(after.tone, 1.0, kOneColour);
    EXPECT_LT(after.colour_spread, kOneColour);
    EXPECT_LT(after.level_spread, kOneColour);
    // What there was to correct: a test on even light would prove nothing.
    EXPECT_GT(before.unevenness, 10.0 * kFlat);
    EXPECT_GT(before.level_spread, 10.0 * kFlat);
}

}  // namespace
}  // namespace aphotic::survey
