// SPDX-License-Identifier: BSD-3-Clause
//
// The correction of a survey as a program without our command calls it: poses of its own, and maps
// that no rig made; and without a model: formats, masks, and what is done again.
#include "survey/correct/correction_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/has.h"
#include "support/png.h"
#include "support/raw_survey.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
        if (roll_of_a_rad_ != 0.0) {
            std::vector<ImagePose> poses;
            for (const ImageFile& file : survey.files)
                poses.push_back(survey.navigation->pose_of(file.source));
            poses.front().sled.roll_rad = roll_of_a_rad_;
            survey.navigation = Navigation("track", poses);
        }
        return correct_survey(survey, options_, watch_);
    }

    RawSurvey raw_;
    CorrectionOptions options_{.run = {.folder = raw_.path("out"), .format = {.format = "exr"}}};
    RunWatch watch_;
    double roll_of_a_rad_ = 0.0;
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
    EXPECT_EQ(report["doubtful"].size(), 6U);
    EXPECT_EQ(report["not_checked"],
              "altitudes, red for blue, radians: 4 images with light; needed: 12");
}

TEST_F(CorrectionRun, GivenAgainItKeepsItsGainAndDoesWhatIsNewAlone) {
    const CorrectionReport first = correct();
    const auto expect = [&](std::size_t corrected, std::size_t kept, const char* about) {
        const CorrectionReport report = correct();
        EXPECT_EQ(report.run->corrected, corrected) << about;
        EXPECT_EQ(report.run->kept, kept) << about;
        return report;
    };
    raw_.write("b", 8.0F);
    const CorrectionReport again = expect(1, 3, "another image of that name");
    EXPECT_EQ(again.gain.gain, first.gain.gain);
    EXPECT_EQ(again.settings_sha256, first.settings_sha256);
    roll_of_a_rad_ = 0.1;
    expect(1, 3, "another attitude of one");
    const fs::path journal = raw_.path("out/corrected.jsonl");
    const std::string notes = read_text_file(journal);
    write_text_file(journal, notes.substr(0, notes.size() - 20));
    expect(1, 3, "a line that was cut short");
    options_.limit.share = 0.02;
    expect(4, 0, "other settings");
    options_.gain_images = 2;
    const CorrectionReport few = expect(4, 0, "the gain of other images");
    EXPECT_EQ(few.gain.images, (std::vector<std::string>{"a", "c"}));
    EXPECT_EQ(few.not_checked, first.not_checked);
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

class BaselineRun : public testing::Test {
  protected:
    RunOutcome run(Baseline baseline) {
        options_.baseline = baseline;
        Survey survey = raw_.survey();
        survey.camera = camera_;
        return *correct_survey(survey, options_, watch_).run;
    }

    RawSurvey raw_;
    CameraNumbers camera_;
    CorrectionOptions options_{.run = {.folder = raw_.path("out"), .format = {.format = "exr"}},
                               .of_baselines = {.order = 1}};
    RunWatch watch_;
};

// Light that falls in a line leaves a polynomial of order 1 nothing but the survey's mean, 1.15.
TEST_F(BaselineRun, LearnsThePatternOfEachAltitude) {
    options_.of_baselines.bin_m = 0.5;
    EXPECT_EQ(run(Baseline::BinnedPolynomial).corrected, 4U);
    constexpr double kFloats = 1e-5;
    for (const char* name : {"out/b.exr", "out/high.exr"}) {
        const std::vector<float> green = RawSurvey::samples_of(raw_.path(name), {"G"});
        for (const float sample : green) EXPECT_NEAR(sample / green[0], 1.0, kFloats) << name;
    }
}

TEST_F(BaselineRun, AloneItDoesWhatIsNewAndLearningItDoesAllAnew) {
    EXPECT_EQ(run(Baseline::Homomorphic).corrected, 4U);
    EXPECT_EQ(run(Baseline::Homomorphic).kept, 4U);
    raw_.write("b", 2.0F);
    const RunOutcome alone = run(Baseline::Homomorphic);
    EXPECT_EQ(alone.corrected, 1U);
    EXPECT_EQ(alone.kept, 3U);

    EXPECT_EQ(run(Baseline::LogPolynomial).corrected, 4U) << "another correction";
    EXPECT_EQ(run(Baseline::LogPolynomial).kept, 4U);
    raw_.write("b", 5.0F);
    EXPECT_EQ(run(Baseline::LogPolynomial).corrected, 4U) << "another pattern";
    const std::string a = read_text_file(raw_.path("out/a.exr"));
    const std::string c = read_text_file(raw_.path("out/c.exr"));
    fs::remove(raw_.path("out/c.exr"));
    EXPECT_EQ(run(Baseline::LogPolynomial).corrected, 1U);
    EXPECT_EQ(read_text_file(raw_.path("out/a.exr")), a);
    EXPECT_EQ(read_text_file(raw_.path("out/c.exr")), c) << "what comes of an interruption";
    options_.of_baselines.order = 2;
    EXPECT_EQ(run(Baseline::LogPolynomial).corrected, 4U) << "other settings";
}

// The median of the images' own medians, (1.0625 + 0.1 c) times 0.1, 0.5, 1 and 3, is the third in
// order; it becomes a fifth. An image that comes later is shown as the others were.
TEST_F(BaselineRun, ShowsAllImagesUnderOneBalance) {
    constexpr double kFloats = 1e-6;
    options_.run.format.srgb = SrgbFormat{.format = "png"};
    EXPECT_EQ(run(Baseline::Homomorphic).corrected, 4U);
    const auto balance = [&] {
        return nlohmann::json::parse(
                   read_text_file(raw_.path("out/baseline.json")))["srgb"]["balance"]
            .get<PerChannel>();
    };
    const PerChannel first = balance();
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_NEAR(first[c] * (1.0625 + 0.1 * static_cast<double>(c)), 0.2, kFloats) << c;
    }
    raw_.write("later", 20.0F);
    const RunOutcome second = run(Baseline::Homomorphic);
    EXPECT_EQ(second.corrected, 1U);
    EXPECT_EQ(second.kept, 4U);
    EXPECT_EQ(balance(), first);
    const DecodedPng shown = decode_png(read_text_file(raw_.path("out/srgb/b.png")));
    EXPECT_EQ(shown.width, RawSurvey::kWidth_px);
    // By the standard's curve.
    const std::vector<float> linear =
        RawSurvey::samples_of(raw_.path("out/b.exr"), {"R", "G", "B"});
    const double red = std::min(1.0, first[0] * linear[0]);
    const double encoded =
        red <= 0.0031308 ? 12.92 * red : 1.055 * std::pow(red, 1.0 / 2.4) - 0.055;
    EXPECT_NEAR(static_cast<double>(shown.pixels[0] >> 16U & 0xFFU), 255.0 * encoded, 0.51);
}

// The survey's images are at 1.9, 2, 2.1 and 3.5 m.
TEST_F(BaselineRun, ExponentialsNeedFourAltitudes) {
    EXPECT_EQ(run(Baseline::AltitudeExponential).corrected, 4U);
    EXPECT_EQ(run(Baseline::AltitudeExponential).kept, 4U);
    options_.of_baselines.bin_m = 0.5;
    const std::string said = refusal_of([&] { run(Baseline::AltitudeExponential); });
    EXPECT_EQ(said,
              "altitude-exponential: found images in 2 bins of altitude, 0.5 m wide; "
              "allowed: 4 or more");
}

// White is the white level less the black level: of sigma so large that the image keeps its shape.
TEST_F(BaselineRun, SixteenBitsAreSharesOfTheWhiteLevel) {
    options_.run.format = {.format = "png", .mask = true};
    options_.of_baselines.low = 1.0;  // changes nothing
    camera_ = {.mosaic = Mosaic::None, .black_level = 1.0F, .white_level = 4.0F};
    const RunOutcome outcome = run(Baseline::Homomorphic);
    EXPECT_EQ(outcome.corrected, 4U);
    const DecodedPng image = decode_png(read_text_file(raw_.path("out/c.png")));
    const DecodedPng mask = decode_png(read_text_file(raw_.path("out/c.mask.png")));
    const std::vector<float> light = RawSurvey::light();
    for (std::size_t i = 0; i < RawSurvey::kPixels_of_plane; ++i) {
        const float red = 3.0F * light[i];
        const float blue = 3.0F * light[i + 2 * RawSurvey::kPixels_of_plane];
        const std::uint32_t doubts = mask.pixels[i] & 0xFFU;
        EXPECT_EQ((doubts & kSaturated) != 0, blue >= 4.0F) << i;
        EXPECT_EQ((doubts & kClipped) != 0, blue > 4.0F) << i;
        if (red > 4.0F) continue;
        constexpr double kStep =
            1.0;  // of eight bits, of which the picture's reader gives the upper
        EXPECT_NEAR(image.pixels[i] >> 16U & 0xFFU, 255.0 * (red - 1.0) / 3.0, kStep) << i;
    }
    EXPECT_GT(outcome.doubtful_share("saturated"), 0.0);
    EXPECT_EQ(outcome.doubtful_share("edge"), 0.0);
}

TEST_F(BaselineRun, SixteenBitsOfFloatsNeedAWhiteLevel) {
    options_.run.format = {.format = "tiff"};
    const RunOutcome outcome = run(Baseline::Homomorphic);
    ASSERT_EQ(outcome.skipped.size(), 4U);
    EXPECT_TRUE(has(outcome.skipped[0].why, "--white-level"));
}

TEST_F(BaselineRun, ItsReportIsWhatItLeaves) {
    options_.baseline = Baseline::Homomorphic;
    const nlohmann::ordered_json report = to_json(correct_survey(raw_.survey(), options_, watch_));
    EXPECT_EQ(nlohmann::ordered_json::parse(read_text_file(raw_.path("out/baseline.json"))),
              report);
    EXPECT_EQ(report["baseline"], "homomorphic");
    EXPECT_EQ(report["settings"]["format"], "exr");
    EXPECT_EQ(report["kept"], 0);
}

TEST_F(BaselineRun, BinsOfAltitudeNeedANavigation) {
    options_.baseline = Baseline::BinnedPolynomial;
    Survey survey = raw_.survey();
    survey.navigation.reset();
    EXPECT_THROW(correct_survey(survey, options_, watch_), InputError);
    EXPECT_FALSE(fs::exists(raw_.path("out")));
}

}  // namespace
}  // namespace aphotic::correction_run_test
