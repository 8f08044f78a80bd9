// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic atlas, as a user runs it.
#include "spectral/exr.h"
#include "support/run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

constexpr int kAnswerIsNo = 1;
constexpr int kBadInput = 2;

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

    TempFolder folder_;
};

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
    ASSERT_EQ(
        run_aphotic(
            folder_.path(),
            {"lightmap", "rig.toml", "-o", "map.exr", "--altitude-m", "2.2", "--pitch-deg", "-5"})
            .status,
        0);
    const std::vector<std::string> channels{"R", "G", "B"};
    std::vector<float> bin(std::size_t{3} * 68 * 51);
    std::vector<float> map(bin.size());
    ExrReader(folder_.path() / "atlas" / "bins" / "a2.2_p-5_r0_w1.exr")
        .read_rows(0, 51, channels, bin);
    ExrReader(folder_.path() / "map.exr").read_rows(0, 51, channels, map);
    constexpr float kTwoTables = 2.2e-5F;  // each is right to 1e-5
    for (std::size_t i = 0; i < bin.size(); ++i) ASSERT_NEAR(bin[i] / map[i], 1.0F, kTwoTables);
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
    for (const char* bin : {"1.80", "1.90", "2.00", "2.10", "2.20"}) {
        EXPECT_TRUE(fs::exists(folder_.path() / "atlas" / "bayer" /
                               (std::string("altitude_") + bin + "m.exr")));
    }
    EXPECT_TRUE(fs::exists(folder_.path() / "atlas" / "exponential.exr"));
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
}  // namespace aphotic
