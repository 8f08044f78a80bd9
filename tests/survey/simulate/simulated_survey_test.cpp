// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/simulated_survey.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "image/output_images.h"
#include "lightmap/lightmap.h"
#include "rig/file/rig_reader.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

namespace aphotic::simulated_survey_test {
namespace {

namespace fs = std::filesystem;

// A float's rounding, of a few operations.
constexpr double kFloat = 4e-7;

class Simulated : public testing::Test {
  protected:
    Simulated() {
        put_small_scene(fs::path(APHOTIC_SOURCE_DIR) / "scenes/habcam.toml", temp_.path());
    }

    [[nodiscard]] SimulatedSurvey survey(const std::string& folder, int images = 2) const {
        SimulatedSurvey survey{.folder = temp_.path() / folder,
                               .rig = read_rig(temp_.path() / "rig.toml"),
                               .legs = flight({}, 1, images),
                               .corners = corners_of(FlightRanges{})};
        survey.camera.electrons_per_signal =
            electrons_for_share(survey.rig, survey.corners, survey.camera.saturation_e, 0.25);
        return survey;
    }
    static void make(const SimulatedSurvey& survey) {
        begin_survey(survey);
        make_truth_by_lightmaps(survey);
        finish_survey(survey);
    }
    static std::string bytes(const SimulatedSurvey& survey, const std::string& name) {
        return read_text_file(survey.folder / name);
    }
    static std::vector<float> texture_of(const SimulatedSurvey& survey, const Leg& leg) {
        ExrReader exr(survey.folder / "texture" / (leg.name + ".exr"));
        return exr.planes(std::vector<std::string>{"Y"});
    }

    TempFolder temp_;
};

TEST_F(Simulated, TruthIsTheFloorsLightTimesItsTexture) {
    const SimulatedSurvey made = survey("out");
    make(made);
    const LightmapMaker maker(made.rig, paths_of(made.rig, made.corners), {});
    for (const Leg& leg : made.legs) {
        const Lightmap map = maker.map(leg.sled);
        const CameraImage truth = read_signals(truth_file(made, leg));
        const std::vector<float> texture = texture_of(made, leg);
        ASSERT_EQ(truth.samples.size(), 3 * texture.size());
        for (std::size_t i = 0; i < truth.samples.size(); ++i) {
            const double expected = double{map.samples[i]} * texture[i % texture.size()];
            ASSERT_NEAR(truth.samples[i], expected, kFloat * expected) << leg.name << ' ' << i;
        }
    }
}

TEST_F(Simulated, TheVeilNeverMetTheFloor) {
    SimulatedSurvey made = survey("out", 1);
    std::string toml = read_text_file(temp_.path() / "rig.toml");
    toml = std::regex_replace(toml,
                              std::regex("absorption = .*\n *multiple .*\n"),
                              "type = \"jerlov-1C\"\nphase = \"petzold-coast\"\n");
    toml = std::regex_replace(toml, std::regex("400, 720"), "400, 700");
    write_file(temp_.path() / "murky.toml", toml);
    made.rig = read_rig(temp_.path() / "murky.toml");
    ASSERT_TRUE(made.rig.water.scatters());
    make(made);
    const Leg& leg = made.legs.front();
    const LightmapMaker maker(
        made.rig, paths_of(made.rig, made.corners), {.veil_tolerance = made.tolerance});
    const Lightmap map = maker.map(leg.sled);
    const CameraImage truth = read_signals(truth_file(made, leg));
    const std::vector<float> texture = texture_of(made, leg);
    for (std::size_t i = 0; i < truth.samples.size(); ++i) {
        const double expected =
            double{map.samples[i]} * texture[i % texture.size()] + double{map.veil[i]};
        ASSERT_NEAR(truth.samples[i], expected, kFloat * expected) << i;
    }
}

TEST_F(Simulated, ItsTextureHasItsContrast) {
    SimulatedSurvey made = survey("out", 12);
    made.texture = 0.3;
    make(made);
    double mean = 0.0;
    double squares = 0.0;
    for (const Leg& leg : made.legs) {
        for (const float t : texture_of(made, leg)) {
            mean += t;
            squares += t * t;
        }
    }
    const double pixels = 12.0 * made.rig.camera.width_px * made.rig.camera.height_px;
    mean /= pixels;
    // Twelve views of about three by three of the coarsest cells, a sixth of the variance.
    constexpr double kFewCells = 0.05;
    EXPECT_NEAR(mean, 1.0, kFewCells);
    EXPECT_NEAR(std::sqrt(squares / pixels - mean * mean), 0.3, kFewCells);
}

TEST_F(Simulated, RawIsWhatTheCameraMakesOfTheTruth) {
    const SimulatedSurvey made = survey("out", 1);
    make(made);
    const Leg& leg = made.legs.front();
    const std::vector<std::uint16_t> expected = raw_samples(
        read_signals(truth_file(made, leg)), made.camera, NoiseOf{.seed = 1, .image = 1});
    const AnyImage raw = open_any_image(made.folder / "raw/000001.tif");
    EXPECT_EQ(raw.full_scale, 65535.0) << "16 bits";
    const std::vector<float> samples = raw.samples(0);
    ASSERT_EQ(samples.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(std::lround(65535.0 * samples[i]), expected[i]) << i;
}

TEST_F(Simulated, ExposesTheLowestFloorToItsShare) {
    const SimulatedSurvey made = survey("out");
    Rig rig = made.rig;
    rig.sled = {.altitude_m = 1.3};
    const Lightmap map = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
    EXPECT_NEAR(made.camera.electrons_per_signal * std::ranges::max(map.samples),
                0.25 * 15000.0,
                kFloat * 15000.0);
}

TEST_F(Simulated, DependsNeitherOnThreadsNorOnItsLength) {
    SimulatedSurvey few = survey("few", 1);
    make(few);
    SimulatedSurvey many = survey("many", 3);
    many.jobs = 3;
    make(many);
    for (const char* file : {"raw/000001.tif", "truth/000001.exr", "texture/000001.exr"})
        EXPECT_EQ(bytes(few, file), bytes(many, file)) << file;
    // And grows to it, without a second look at what is there.
    const fs::path first = few.folder / "raw/000001.tif";
    const auto made = fs::last_write_time(first);
    few.legs = many.legs;
    make(few);
    EXPECT_EQ(fs::last_write_time(first), made);
    for (const char* file : {"raw/000003.tif", "navigation.txt", "navigation-measured.txt"})
        EXPECT_EQ(bytes(few, file), bytes(many, file)) << file;
    EXPECT_EQ(missing_bytes(few), 0U);
}

TEST_F(Simulated, IsOneSurveyInItsFolder) {
    SimulatedSurvey made = survey("out", 1);
    make(made);
    const auto refused = [](const SimulatedSurvey& other) {
        return refusal_of([&] { begin_survey(other); });
    };
    EXPECT_EQ(refused(made), kAccepted);
    SimulatedSurvey other = made;
    other.seed = 2;
    EXPECT_TRUE(has(refused(other), "another folder"));
    other = made;
    other.rig.digest = "another";
    EXPECT_TRUE(has(refused(other), "survey.json: found a survey of another rig; allowed: "));
    other = made;
    other.camera.read_noise_e = 9.0;
    EXPECT_NE(refused(other), kAccepted);
    other = made;
    other.legs.push_back(made.legs.front());
    other.folder = temp_.path() / "twice";
    EXPECT_EQ(refused(other), "found two images named 000001; allowed: names that differ");
    EXPECT_FALSE(fs::exists(other.folder));
}

}  // namespace
}  // namespace aphotic::simulated_survey_test
