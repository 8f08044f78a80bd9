// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic atlas, as a user runs it.
#include "image/exr.h"
#include "support/run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <regex>

namespace aphotic::atlas_test {
namespace {

namespace fs = std::filesystem;

constexpr int kAnswerIsNo = 1;
constexpr int kBadInput = 2;
constexpr int kHeight_px = 51;
constexpr std::size_t kPixels = std::size_t{68} * kHeight_px;
constexpr float kTwoTables = 2.2e-5F;  // two maps, each of them right to 1e-5

class CommandAtlas : public testing::Test {
  protected:
    void SetUp() override {
        std::string text = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*resolution\s*=[^\n]*)"), "\nresolution = [68, 51]");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*pixel_pitch_um\s*=[^\n]*)"), "\npixel_pitch_um = 129.0");
        write_file(folder_.path() / "rig.toml", text);
    }

    [[nodiscard]] CommandResult atlas(const std::vector<std::string>& options) const {
        std::vector<std::string> arguments{"atlas", "rig.toml", "-o", "atlas"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_aphotic(folder_.path(), arguments);
    }

    [[nodiscard]] nlohmann::json manifest() const {
        return nlohmann::json::parse(read_text_file(folder_.path() / "atlas" / "atlas.json"));
    }

    // What aphotic lightmap makes.
    [[nodiscard]] std::vector<float> map(const std::string& source,
                                         const std::vector<std::string>& options) const {
        std::vector<std::string> arguments{"lightmap", source, "-o", "map.exr"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const CommandResult run = run_aphotic(folder_.path(), arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        return samples("map.exr", {"R", "G", "B"});
    }

    [[nodiscard]] std::vector<float> samples(const fs::path& file,
                                             const std::vector<std::string>& channels) const {
        std::vector<float> all(channels.size() * kPixels);
        ExrReader(folder_.path() / file).read_rows(0, kHeight_px, channels, all);
        return all;
    }

    // The rig's file with another value of a key.
    void change(const std::string& key, const std::string& value) const {
        const fs::path file = folder_.path() / "rig.toml";
        write_file(file,
                   std::regex_replace(read_text_file(file),
                                      std::regex("(\\n\\s*" + key + "\\s*=)[^\n]*"),
                                      "$1 " + value));
    }

    // Every cone open to 90 degrees, so that no edge is in view.
    void open_cones() const {
        const fs::path file = folder_.path() / "rig.toml";
        write_file(file,
                   std::regex_replace(read_text_file(file),
                                      std::regex(R"(half_angle_deg\s*=\s*[0-9.]+)"),
                                      "half_angle_deg = 90.0"));
    }

    TempFolder folder_;
};

void expect_near(const std::vector<float>& found, const std::vector<float>& wanted, float error) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i] / wanted[i], 1.0F, error);
}

TEST_F(CommandAtlas, WritesBinsOverAllAxes) {
    const CommandResult run = atlas({"--altitude", "1.8:2.2:0.2", "--pitch", "-5:5:5", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(nlohmann::json::parse(run.out)["bins"], 9);
    const auto manifest =
        nlohmann::json::parse(read_text_file(folder_.path() / "atlas" / "atlas.json"));
    EXPECT_EQ(manifest["axes"]["altitude_m"], nlohmann::json({1.8, 2.0, 2.2}));
    EXPECT_EQ(manifest["axes"]["pitch_deg"], nlohmann::json({-5.0, 0.0, 5.0}));
    EXPECT_EQ(manifest["bins"].size(), 9U);
    for (const auto& bin : manifest["bins"]) {
        EXPECT_TRUE(fs::exists(folder_.path() / "atlas" / bin["file"].get<std::string>()));
    }
    // A bin is the map that the other command makes.
    expect_near(samples("atlas/bins/a2.2_p-5_r0_w1.exr", {"R", "G", "B"}),
                map("rig.toml", {"--altitude-m", "2.2", "--pitch-deg", "-5"}),
                kTwoTables);
}

// Each bin is the map of a rig that has its roll and water, which no two of them share.
TEST_F(CommandAtlas, RollAndWaterAreAxesToo) {
    const CommandResult run = atlas(
        {"--altitude", "2", "--roll", "-4:8:12", "--water-multiple", "0.5:1.5:0.5", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto written = manifest();
    ASSERT_EQ(written["bins"].size(), 6U);
    for (const auto& bin : written["bins"]) {
        change("roll_deg", bin["roll_deg"].dump());
        change("multiple", bin["water_multiple"].dump());
        expect_near(samples("atlas/" + bin["file"].get<std::string>(), {"R", "G", "B"}),
                    map("rig.toml", {}),
                    kTwoTables);
    }
}

// At a bin it is the bin; in the middle of a step, of altitude's logarithm, the mean of logarithms;
// and at any point the true map, as far as the atlas says.
TEST_F(CommandAtlas, IsBlendedIntoMaps) {
    open_cones();
    ASSERT_EQ(atlas({"--altitude", "2:2.42:0.42", "--pitch", "0:5:5", "--roll", "-2:2:4"}).status,
              0);
    const std::vector<std::string> attitude{"--pitch-deg", "5", "--roll-deg", "-2"};
    const auto at = [&](const std::string& altitude_m) {
        std::vector<std::string> options{"--altitude-m", altitude_m};
        options.insert(options.end(), attitude.begin(), attitude.end());
        return map("atlas", options);
    };
    const auto lower = samples("atlas/bins/a2_p5_r-2_w1.exr", {"R", "G", "B"});
    const auto upper = samples("atlas/bins/a2.42_p5_r-2_w1.exr", {"R", "G", "B"});
    EXPECT_EQ(at("2"), lower);
    EXPECT_EQ(at("2.42"), upper);
    std::vector<float> mean;
    for (std::size_t i = 0; i < lower.size(); ++i) mean.push_back(std::sqrt(lower[i] * upper[i]));
    constexpr float kRounding = 2e-6F;
    expect_near(at("2.2"), mean, kRounding);  // 2.2^2 = 2 * 2.42

    const std::vector<std::string> between{
        "--altitude-m", "2.3", "--pitch-deg", "1.5", "--roll-deg", "0.5"};
    const auto stated = manifest()["interpolation"]["worst"].get<float>();
    EXPECT_LT(stated, 0.02F);
    expect_near(map("atlas", between), map("rig.toml", between), stated);
    EXPECT_NE(map("atlas", between), lower);
}

// The lamps, by whose white a rig's preview is shown, are not in an atlas: nobody asked for them.
TEST_F(CommandAtlas, HasPreviews) {
    ASSERT_EQ(atlas({"--altitude", "2:2.4:0.2"}).status, 0);
    const auto preview = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments{
            "lightmap", "atlas", "--altitude-m", "2.1", "-o", "map.exr", "--preview", "map.png"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const CommandResult run = run_aphotic(folder_.path(), arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_TRUE(fs::exists(folder_.path() / "map.exr"));
        return read_text_file(folder_.path() / "map.png");
    };
    const std::string by_default = preview({});
    EXPECT_EQ(by_default, preview({"--preview-white", "image"}));
    EXPECT_NE(by_default, preview({"--preview-white", "none"}));
}

TEST_F(CommandAtlas, IsNoMapBeyondItsAxesOrWithWhatNeedsARig) {
    ASSERT_EQ(atlas({"--altitude", "2:2.4:0.2"}).status, 0);
    const auto refused = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"lightmap", "atlas", "-o", "map.exr"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const CommandResult run = run_aphotic(folder_.path(), arguments);
        EXPECT_EQ(run.status, kBadInput) << options.front();
        EXPECT_FALSE(fs::exists(folder_.path() / "map.exr")) << options.front();
        return run.err;
    };
    EXPECT_NE(refused({"--altitude-m", "2.5"}).find("allowed: from 2 to 2.4"), std::string::npos);
    EXPECT_NE(refused({"--json"}).find("--altitude: found none"), std::string::npos);
    const std::vector<std::string> there{"--altitude-m", "2.1"};
    for (const std::vector<std::string>& option : std::vector<std::vector<std::string>>{
             {"--per-strobe"},
             {"--per-cone"},
             {"--error", "1e-5"},
             {"--pitch-deg", "1"},
             {"--water-multiple", "2"},
             {"--preview", "map.png", "--preview-white", "lamp"}}) {
        std::vector<std::string> options = option;
        options.insert(options.end(), there.begin(), there.end());
        EXPECT_NE(refused(options).find("allowed"), std::string::npos) << option.front();
    }
    EXPECT_NE(
        run_aphotic(folder_.path(), {"lightmap", ".", "-o", "map.exr"}).err.find("atlas.json"),
        std::string::npos);
}

TEST_F(CommandAtlas, SaysNoWhenTheStepsAreTooWide) {
    const CommandResult run = atlas({"--altitude", "1:4:1.5", "--tolerance", "1e-4"});
    EXPECT_EQ(run.status, kAnswerIsNo) << run.err;
    EXPECT_NE(run.out.find("not within the tolerance"), std::string::npos) << run.out;
    EXPECT_EQ(atlas({"--altitude", "1:4:0.1", "--tolerance", "0.05"}).status, 0);
}

TEST_F(CommandAtlas, ExportsWhatCorrectorsUse) {
    const CommandResult run =
        atlas({"--altitude", "1.8:2.2:0.1", "--export", "bayer,exponential", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto said = nlohmann::json::parse(run.out);
    EXPECT_EQ(said["exports"]["bayer"]["bins"], 5);
    EXPECT_GT(said["exports"]["exponential"]["rms"], 0.0);
    EXPECT_TRUE(fs::exists(folder_.path() / "atlas" / "exponential.exr"));
    const auto exports = manifest()["exports"];
    EXPECT_EQ(exports["exponential"]["rms"], said["exports"]["exponential"]["rms"]);
    ASSERT_EQ(exports["bayer"].size(), 5U);
    EXPECT_EQ(exports["bayer"][1]["file"], "bayer/altitude_1.90m.exr");
    for (const auto& mosaic : exports["bayer"]) {
        const auto found = samples("atlas/" + mosaic["file"].get<std::string>(), {"Y"});
        const auto all = map("rig.toml", {"--altitude-m", mosaic["altitude_m"].dump()});
        for (std::size_t i = 0; i < kPixels; ++i) {
            const std::size_t row = i / 68;
            const std::size_t column = i % 68;
            const bool is_red = row % 2 == 0 && column % 2 == 0;
            const bool is_blue = row % 2 == 1 && column % 2 == 1;
            const std::size_t channel = is_red ? 0 : is_blue ? 2 : 1;
            ASSERT_NEAR(found[i] / all[channel * kPixels + i], 1.0F, kTwoTables) << i;
        }
    }
}

// Names tell altitudes apart, and what another run exported is gone, but for what is not ours.
TEST_F(CommandAtlas, ExportsAreOfThisRunAlone) {
    ASSERT_EQ(
        atlas({"--altitude", "1:1.02:0.004", "--export", "bayer,exponential", "--json"}).status, 0);
    const fs::path mosaics = folder_.path() / "atlas" / "bayer";
    const auto count = [&] { return std::distance(fs::directory_iterator(mosaics), {}); };
    EXPECT_EQ(count(), 6);
    EXPECT_EQ(ExrReader(mosaics / "altitude_1.004m.exr").attribute("aphotic:altitude_m"), "1.004");
    write_file(mosaics / "notes.txt", "the user's own");
    const CommandResult again = atlas({"--altitude", "1:1.02:0.02", "--export", "bayer"});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(count(), 3);
    EXPECT_TRUE(fs::exists(mosaics / "altitude_1.02m.exr"));
    EXPECT_FALSE(fs::exists(folder_.path() / "atlas" / "exponential.exr"));
    EXPECT_FALSE(manifest()["exports"].contains("exponential"));
    EXPECT_EQ(manifest()["exports"]["bayer"].size(), 2U);
}

TEST_F(CommandAtlas, RefusesAFitOverFewAltitudesBeforeItBegins) {
    const CommandResult run = atlas({"--altitude", "1:3:1", "--export", "exponential"});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_NE(run.err.find("found 3 altitudes; allowed: 4 or more"), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "atlas"));
}

TEST_F(CommandAtlas, RefusesBinsWithAStrobeUnderTheFloorBeforeItBegins) {
    const CommandResult run = atlas({"--altitude", "0.02:0.1:0.04", "--pitch", "-30:30:30"});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_NE(run.err.find("rig.toml: altitude 0.02 m, pitch -30, roll 0 degrees: strobe 'fore' "
                           "stands 0.2327 m under the sea floor"),
              std::string::npos)
        << run.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "atlas"));
}

TEST_F(CommandAtlas, SaysHowFarWholeMapsAreOff) {
    const CommandResult run = atlas({"--altitude", "1:4:0.5", "--tolerance", "0.05"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto whole = manifest()["interpolation"]["whole_maps"];
    EXPECT_EQ(whole["limit"], 0.05);
    EXPECT_GT(whole["share_over_limit"], 0.05);
    EXPECT_NE(run.out.find("of their samples by over 0.05"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("bins of 68 x 51 pixels: up to "), run.out.find(" ") + 1) << run.out;
}

TEST_F(CommandAtlas, RefusesMoreBinsThanAnyoneHasRoomFor) {
    const CommandResult run =
        atlas({"--altitude", "1:4:0.01", "--pitch", "-5:5:0.1", "--roll", "-5:5:0.1"});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_NE(run.err.find("found 301 x 101 x 101 x 1 = 3070501 bins; allowed: up to 100000"),
              std::string::npos)
        << run.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "atlas"));
}

TEST_F(CommandAtlas, RefusesAxesThatAreNone) {
    for (const char* axis :
         {"4:1:0.1", "1:4", "1:4:0.7", "1:4:0", "one", "1:4:0.1x", "0:4:1", ""}) {
        const CommandResult run = atlas({"--altitude", axis});
        EXPECT_EQ(run.status, kBadInput) << axis;
        EXPECT_FALSE(fs::exists(folder_.path() / "atlas")) << axis;
    }
}

}  // namespace
}  // namespace aphotic::atlas_test
