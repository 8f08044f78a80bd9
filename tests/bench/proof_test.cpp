// SPDX-License-Identifier: BSD-3-Clause
//
// The core of the surveys in docs/background/accuracy.md, with half as many pixels a side: what
// POV-Ray rendered, divided by the lightmap of each image's own altitude and attitude.
#include "bench/survey/chart.h"
#include "image/output_images.h"
#include "support/run_command.h"
#include "support/small_survey.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <regex>
#include <string>
#include <vector>

namespace aphotic::survey::proof_test {
namespace {

constexpr int kImages = 4;

// What is asked of a correction without noise.
constexpr double kFlat = 0.01;
// The plan's promise for grey, twice, for a ratio of two channels; and what a tile's height of 0.2
// mm and its frames' half floats add.
constexpr double kOneColour = 2.5e-3;
// With noise a red pixel of the highest image is off by 0.23 of itself, all others by less. Of the
// 480 pixels and more of a kind of tile demosaicing leaves one in four independent: 0.021 of their
// mean. Tone is a mean over twelve such, and in a spread over four images one counts by
// sqrt(3)/4: one standard deviation of either is under 0.01.
constexpr double kNoiseOfMeans = 0.02;

class Proof : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        survey_ = std::make_unique<SmallSurvey>();
        const std::vector<std::string> images{"--images", std::to_string(kImages)};
        const CommandResult made = survey_->make(images);
        ASSERT_EQ(made.status, 0) << made.err;
        const CommandResult card =
            survey_->make({images[0], images[1], "--declare", "Survey_Floor=\"card\""}, "card");
        ASSERT_EQ(card.status, 0) << card.err;
    }
    static void TearDownTestSuite() { survey_.reset(); }

    static std::vector<Leg> legs() { return flight({}, 1, kImages); }
    static CameraImage truth(const Leg& leg) { return read_signals(file("out", leg)); }
    static std::vector<Tile> chart(const Leg& leg) {
        return find_chart(truth(leg), read_signals(file("card", leg)));
    }
    static std::filesystem::path file(const char* folder, const Leg& leg) {
        return survey_->folder() / folder / "truth" / (leg.name + ".exr");
    }

    // The camera by default, and its noise: 8 electrons, 15000 in 4031 numbers.
    static std::vector<std::string> raw_camera() {
        return {"--bayer", "RGGB", "--black-level", "64", "--white-level", "4095"};
    }
    static std::vector<std::string> noisy_camera() {
        std::vector<std::string> camera = raw_camera();
        camera.insert(camera.end(), {"--read-noise", "2.15", "--electrons", "3.72"});
        return camera;
    }

    // Over the chart's pixels, the rms of the rounding to whole numbers over the number itself.
    static std::array<double, kChannels> rounding_of(const Leg& leg, double numbers_per_signal) {
        const CameraImage signal = truth(leg);
        const std::vector<Tile> tiles = chart(leg);
        std::array<double, kChannels> rounding{};
        for (std::size_t c = 0; c < kChannels; ++c) {
            double squares = 0.0;
            double count = 0.0;
            for (std::size_t i = 0; i < tiles.size(); ++i) {
                if (tiles[i] == Tile::None) continue;
                const double number = numbers_per_signal * signal.samples[c * tiles.size() + i];
                squares += 1.0 / (12.0 * number * number);
                count += 1.0;
            }
            rounding[c] = std::sqrt(squares / count);
        }
        return rounding;
    }

    // What `aphotic correct` makes of a folder of images.
    static SurveyScore corrected(const std::string& folder, std::vector<std::string> options) {
        const std::string result = "corrected-" + std::regex_replace(folder, std::regex("/"), "-");
        options.insert(options.begin(), {"correct", folder, "--rig", survey_->rig().string()});
        options.insert(options.end(),
                       {"--nav", "out/navigation.txt", "--format", "exr", "-o", result});
        const CommandResult run = run_aphotic(survey_->folder(), options);
        EXPECT_EQ(run.status, 0) << run.err;
        return scored(survey_->folder() / result);
    }
    static SurveyScore scored(const std::filesystem::path& folder) {
        std::vector<ChartScore> scores;
        for (const Leg& leg : legs()) {
            scores.push_back(score_chart(read_signals(folder / (leg.name + ".exr")), chart(leg)));
            constexpr std::size_t kEnoughPixels = 400;  // to speak of a chart, of 170 x 128
            EXPECT_GT(scores.back().pixels, kEnoughPixels);
        }
        return summed_up(scores);
    }

    static inline std::unique_ptr<SmallSurvey> survey_;
};

TEST_F(Proof, TheChartIsFlatAndOfOneColourOverAltitude) {
    const SurveyScore after = corrected("out/truth", {});
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
    const SurveyScore after = corrected("out/raw", noisy_camera());
    EXPECT_NEAR(after.tone, 1.0, kNoiseOfMeans);
    EXPECT_LT(after.colour_spread, kNoiseOfMeans);
    EXPECT_LT(after.level_spread, kNoiseOfMeans);
    // Images that nothing corrected are told apart from these by each of the three.
    const SurveyScore before = scored(survey_->folder() / "out/truth");
    EXPECT_GT(std::abs(before.tone - 1.0), kNoiseOfMeans);
    EXPECT_GT(before.colour_spread, 4.0 * kNoiseOfMeans);
    EXPECT_GT(before.level_spread, 4.0 * kNoiseOfMeans);
}

// A limit that half of all pixels are under, most of them for their red alone. What is held grows
// darker; were red held by itself, colour would wander by 0.25.
TEST_F(Proof, AGainThatIsHeldCostsBrightnessAndNotColour) {
    std::vector<std::string> camera = noisy_camera();
    camera.insert(camera.end(), {"--most-noise", "0.1"});
    const SurveyScore held = corrected("out/raw", camera);
    EXPECT_LT(held.colour_spread, kNoiseOfMeans);
    const SurveyScore before = scored(survey_->folder() / "out/truth");
    EXPECT_LT(held.level_spread, before.level_spread);
    EXPECT_LT(held.unevenness, before.unevenness);
}

// What is left of a chart in such images without noise is the rounding to whole numbers: an rms of
// 1/sqrt(12) where it is spread evenly, never more than 1/2.
TEST_F(Proof, RawImagesWithoutNoiseAreFlatToTheirRounding) {
    const CommandResult clean =
        survey_->make({"--images", std::to_string(kImages), "--no-noise"}, "clean");
    ASSERT_EQ(clean.status, 0) << clean.err;
    const SurveyScore after = corrected("clean/raw", raw_camera());
    EXPECT_LT(after.unevenness, kFlat);
    EXPECT_NEAR(after.tone, 1.0, kOneColour);
    EXPECT_LT(after.colour_spread, kOneColour);
    EXPECT_LT(after.level_spread, kOneColour);
    const nlohmann::json camera = nlohmann::json::parse(
        read_text_file(survey_->folder() / "clean/survey.json"))["settings"]["camera"];
    const double numbers_per_signal =
        camera["gain_dn_per_e"].get<double>() * camera["electrons_per_signal"].get<double>();
    for (const Leg& leg : legs()) {
        const ChartScore score = score_chart(
            read_signals(survey_->folder() / "corrected-clean-raw" / (leg.name + ".exr")),
            chart(leg));
        const std::array<double, kChannels> rounding = rounding_of(leg, numbers_per_signal);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_GT(score.unevenness[c], 0.5 * rounding[c]) << leg.name << ' ' << c;
            EXPECT_LT(score.unevenness[c], std::sqrt(3.0) * rounding[c]) << leg.name << ' ' << c;
        }
    }
}

}  // namespace
}  // namespace aphotic::survey::proof_test
