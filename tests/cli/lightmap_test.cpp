// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic lightmap, as a user runs it.
#include "image/exr.h"
#include "spectral/integrator.h"
#include "support/run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

namespace aphotic::lightmap_test {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;
constexpr int kRunFailed = 3;
// --error by default, and the rounding of floats.
constexpr double kError = 1.1e-5;

class CommandLightmap : public testing::Test {
  protected:
    void SetUp() override {
        std::string text = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*resolution\s*=[^\n]*)"), "\nresolution = [160, 120]");
        text = std::regex_replace(
            text, std::regex(R"(\n\s*pixel_pitch_um\s*=[^\n]*)"), "\npixel_pitch_um = 55.0");
        write_file(folder_.path() / "rig.toml", text);
    }

    [[nodiscard]] CommandResult lightmap(const std::vector<std::string>& options = {}) const {
        std::vector<std::string> arguments{"lightmap", "rig.toml", "-o", "map.exr"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_aphotic(folder_.path(), arguments);
    }

    [[nodiscard]] std::vector<float> samples(const std::vector<std::string>& channels) const {
        ExrReader reader(folder_.path() / "map.exr");
        std::vector<float> all(channels.size() * 160 * 120);
        reader.read_rows(0, reader.height_px(), channels, all);
        return all;
    }

    TempFolder folder_;
};

// One pixel in a thousand may be on a beam's edge, and step.
void expect_equal(const std::vector<float>& found, const std::vector<float>& wanted) {
    constexpr double kOnEdges = 1e-3;
    ASSERT_EQ(found.size(), wanted.size());
    int off = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        off += std::abs(found[i] / wanted[i] - 1.0F) > kError ? 1 : 0;
    }
    EXPECT_LE(off, kOnEdges * static_cast<double>(found.size()));
}

TEST_F(CommandLightmap, IsWhatTheReferenceTraces) {
    const CommandResult run = lightmap({"--pitch-deg", "-3", "--altitude-m", "1.7"});
    ASSERT_EQ(run.status, 0) << run.err;
    std::string text = read_text_file(folder_.path() / "rig.toml");
    text = std::regex_replace(text, std::regex("pitch_deg  = 5.0"), "pitch_deg = -3.0");
    text = std::regex_replace(text, std::regex("altitude_m = 2.0"), "altitude_m = 1.7");
    write_file(folder_.path() / "other.toml", text);
    const CommandResult trace = run_aphotic(
        folder_.path(), {"trace", "other.toml", "-o", "traced", "--wavelengths", "550"});
    ASSERT_EQ(trace.status, 0) << trace.err;
    expect_equal(samples({"R", "G", "B"}),
                 read_signals(folder_.path() / "traced" / "image.exr").samples);
}

TEST_F(CommandLightmap, PartsAddUpToTheWhole) {
    ASSERT_EQ(lightmap({"--per-strobe", "--per-cone", "--normalised"}).status, 0);
    std::vector<double> by_strobe(std::size_t{160} * 120);
    std::vector<double> by_cone(by_strobe.size());
    const auto add = [&](const std::string& channel, std::vector<double>& sum) {
        const std::vector<float> part = samples({channel});
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
    };
    for (const std::string strobe : {"fore", "aft", "port", "starboard"}) {
        add(strobe + ".G", by_strobe);
        for (const char* cone : {".collimated", ".focused", ".diffuse"}) {
            add(strobe + cone + ".G", by_cone);
        }
    }
    const std::vector<float> whole = samples({"G"});
    for (std::size_t i = 0; i < whole.size(); ++i) {
        ASSERT_NEAR(by_strobe[i] / whole[i], 1.0, kError);
        ASSERT_NEAR(by_cone[i] / whole[i], 1.0, kError);
    }
    EXPECT_EQ(*std::ranges::max_element(whole), 1.0F);
}

TEST_F(CommandLightmap, SaysWhatItDidInJson) {
    const CommandResult run = lightmap({"--json", "--preview", "map.png"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto said = nlohmann::json::parse(run.out);
    EXPECT_EQ(said["width_px"], 160);
    EXPECT_EQ(said["channels"], nlohmann::json({"R", "G", "B"}));
    EXPECT_GT(said["peak"][1], 0.0);
    EXPECT_TRUE(fs::exists(folder_.path() / "map.png"));
    ExrReader reader(folder_.path() / "map.exr");
    EXPECT_EQ(reader.attribute("aphotic:altitude_m"), "2");
    EXPECT_EQ(reader.attribute("aphotic:rig_sha256"), said["rig_sha256"]);
}

// What docs/lightmaps.md promises: the error that is asked for and what floats round; of ports what
// was measured; of emitters the lamps that stand for them.
TEST_F(CommandLightmap, PromisesWhatHolds) {
    const auto expect_words = [&](const std::string& words, const CommandResult& run) {
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_NE(run.out.find(words + ";\n"), std::string::npos) << run.out;
    };
    const std::string off_edges = " of a signal off the beams' edges";
    expect_words("exact to 1.1e-05" + off_edges, lightmap());
    expect_words("exact to 8.2e-07" + off_edges, lightmap({"--error", "1e-7"}));
    const std::string text = read_text_file(folder_.path() / "rig.toml");
    write_file(folder_.path() / "rig.toml",
               text +
                   "\n[camera.port]\nshape = \"flat\"\ndistance_mm = 50.0\n"
                   "thickness_mm = 12.0\nglass = \"bk7\"\n");
    expect_words("near to 1.1e-04" + off_edges + ", as measured behind ports and not bounded",
                 lightmap());
    const auto port = nlohmann::json::parse(lightmap({"--json"}).out);
    EXPECT_FALSE(port["promise"]["bounded"]);
    write_file(
        folder_.path() / "rig.toml",
        std::regex_replace(text, std::regex("\nbeam "), "\nemitter_mm = [63.5, 30.2]\nbeam "));
    expect_words("exact to 1.1e-05" + off_edges + ", emitters being grids of lamps", lightmap());
}

TEST_F(CommandLightmap, RefusesTwoPartsOfOneName) {
    const std::string text = read_text_file(folder_.path() / "rig.toml");
    write_file(folder_.path() / "rig.toml",
               std::regex_replace(text, std::regex("\"aft\""), "\"fore.collimated\""));
    const CommandResult run = lightmap({"--per-strobe", "--per-cone"});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_EQ(run.err,
              "aphotic: rig.toml: strobes: found two parts of the light that would be named "
              "fore.collimated, of a strobe and of a cone, or of two cones; allowed: names that "
              "differ\n");
    EXPECT_FALSE(fs::exists(folder_.path() / "map.exr"));
    EXPECT_EQ(lightmap({"--per-strobe"}).status, 0);
}

TEST_F(CommandLightmap, RefusesARigWithObjects) {
    std::string text = read_text_file(folder_.path() / "rig.toml");
    write_file(folder_.path() / "rig.toml",
               text +
                   "\n[[object]]\nname = \"ball\"\nshape = \"sphere\"\ncentre_m = [0, 0, 1.5]\n"
                   "radius_m = 0.1\nreflectance = \"sand\"\n");
    const CommandResult run = lightmap();
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_EQ(run.err,
              "aphotic: rig.toml: found the object 'ball'; allowed: the bare floor, which is all "
              "that a lightmap is of\n");
    EXPECT_FALSE(fs::exists(folder_.path() / "map.exr"));
}

TEST_F(CommandLightmap, RefusesASledThatPutsAStrobeUnderTheFloor) {
    const CommandResult run = lightmap({"--altitude-m", "0.02", "--pitch-deg", "30"});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_NE(run.err.find("strobe 'aft' stands 0.2327 m under the sea floor"), std::string::npos)
        << run.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "map.exr"));
}

TEST_F(CommandLightmap, LeavesNothingWhereItCannotWrite) {
    const CommandResult run =
        run_aphotic(folder_.path(), {"lightmap", "rig.toml", "-o", "no-such-folder/map.exr"});
    EXPECT_EQ(run.status, kRunFailed);
    EXPECT_NE(run.err.find("no-such-folder/map.exr"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace aphotic::lightmap_test
