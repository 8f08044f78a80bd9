// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic lightmap, as a user runs it.
#include "image/exr.h"
#include "spectral/integrator.h"
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace aphotic::lightmap_test {
namespace {

namespace fs = std::filesystem;

// --error by default, and the rounding of floats.
constexpr double kError = 1.1e-5;

class CommandLightmap : public CommandTest {
  protected:
    void SetUp() override {
        write_file(path("rig.toml"),
                   with(scene_text("habcam.toml"),
                        {{"resolution", "[160, 120]"}, {"pixel_pitch_um", "55.0"}}));
    }

    static Arguments lightmap(const Arguments& options = {}) {
        return "lightmap rig.toml -o map.exr" + options;
    }

    [[nodiscard]] std::vector<float> samples(const std::vector<std::string>& channels) const {
        return read_exr(path("map.exr"), channels);
    }
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
    done(lightmap("--pitch-deg -3 --altitude-m 1.7"));
    write_file(path("other.toml"),
               with(text_of("rig.toml"), {{"pitch_deg", "-3.0"}, {"altitude_m", "1.7"}}));
    done("trace other.toml -o traced --wavelengths 550");
    expect_equal(samples({"R", "G", "B"}), read_signals(path("traced/image.exr")).samples);
}

TEST_F(CommandLightmap, PartsAddUpToTheWhole) {
    done(lightmap("--per-strobe --per-cone --normalised"));
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
    const auto said = json_by(lightmap("--json --preview map.png"));
    EXPECT_EQ(said["width_px"], 160);
    EXPECT_EQ(said["channels"], nlohmann::json({"R", "G", "B"}));
    EXPECT_GT(said["peak"][1], 0.0);
    EXPECT_TRUE(fs::exists(path("map.png")));
    ExrReader reader(path("map.exr"));
    EXPECT_EQ(reader.attribute("aphotic:altitude_m"), "2");
    EXPECT_EQ(reader.attribute("aphotic:rig_sha256"), said["rig_sha256"]);
}

// What docs/guides/lightmaps.md promises: the error that is asked for, 1e-6 of tiles and 7e-7 that
// floats round; of ports what was measured; of emitters the lamps that stand for them.
TEST_F(CommandLightmap, PromisesWhatHolds) {
    const std::string off_edges = " of a signal off the beams' edges";
    done(lightmap(), "exact to 1.2e-05" + off_edges + ";\n");
    done(lightmap("--error 1e-7"), "exact to 1.8e-06" + off_edges + ";\n");
    const std::string text = text_of("rig.toml");
    write_file(path("rig.toml"),
               text +
                   "\n[camera.port]\nshape = \"flat\"\ndistance_mm = 50.0\n"
                   "thickness_mm = 12.0\nglass = \"bk7\"\n");
    done(lightmap(),
         "near to 1.1e-04" + off_edges + ", as measured behind ports and not bounded;\n");
    EXPECT_FALSE(json_by(lightmap("--json"))["promise"]["bounded"]);
    write_file(path("rig.toml"), replaced(text, "\nbeam ", "\nemitter_mm = [63.5, 30.2]\nbeam "));
    done(lightmap(), "exact to 1.2e-05" + off_edges + ", emitters being grids of lamps;\n");
}

TEST_F(CommandLightmap, RefusesTwoPartsOfOneName) {
    write_file(path("rig.toml"), replaced(text_of("rig.toml"), "\"aft\"", "\"fore.collimated\""));
    refused(lightmap("--per-strobe --per-cone"),
            "aphotic: rig.toml: strobes: found two parts of the light named fore.collimated, of a "
            "strobe and a cone or of two cones; allowed: names that differ\n");
    done(lightmap("--per-strobe"));
}

TEST_F(CommandLightmap, LeavesNothingWhereItCannotWrite) {
    refused("lightmap rig.toml -o no-such-folder/map.exr", "no-such-folder/map.exr", kRunFailed);
}

// Each is, bit for bit, the map of that altitude alone.
TEST_F(CommandLightmap, OfSeveralAltitudesIsAMapEach) {
    const auto maps = [&](const std::string& altitudes) {
        return json_by(
            fmt::format("lightmap rig.toml -o maps --altitude {} --json", altitudes))["maps"];
    };
    const auto said = maps("1.5,1.8:2:0.1");
    const std::vector<std::pair<std::string, std::string>> wanted{
        {"1.5", "maps/altitude_1.50m.exr"},
        {"1.8", "maps/altitude_1.80m.exr"},
        {"1.9", "maps/altitude_1.90m.exr"},
        {"2", "maps/altitude_2.00m.exr"}};
    ASSERT_EQ(said.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto& [altitude, file] = wanted[i];
        EXPECT_EQ(said[i]["file"], file);
        EXPECT_EQ(ExrReader(path(file)).attribute("aphotic:altitude_m"), altitude);
        done(lightmap(fmt::format("--altitude {}", altitude)));
        EXPECT_TRUE(text_of(file) == text_of("map.exr")) << file;
    }
    // Names tell altitudes apart; maps of another run go, what is not ours stays.
    write_file(path("maps/notes.txt"), "the user's own");
    EXPECT_EQ(maps("1.5,1.504")[1]["file"], "maps/altitude_1.504m.exr");
    EXPECT_EQ(std::distance(fs::directory_iterator(path("maps")), {}), 3);
}

TEST_F(CommandLightmap, ExportsForOplab) {
    const auto said =
        json_by("lightmap rig.toml -o oplab --altitude 1.8:2.2:0.1 --export oplab --json");
    EXPECT_GT(said["oplab"]["rms"], 0.0);
    for (const char* file : {"attenuation_parameters.npy",
                             "correction_gains.npy",
                             "image_corrected_mean.npy",
                             "image_corrected_std.npy"})
        EXPECT_TRUE(fs::exists(path("oplab") / file)) << file;
}

TEST_F(CommandLightmap, RefusesWhatIsByAltitudeBeforeItBegins) {
    for (const std::string& altitudes :
         Arguments(
             "4:1:0.1 1:4 1:4:0.7 1:4:0 1:4:-1 one 1:4:0.1x 0:4:1 2,1 1,1 1,,2 , 1:20000:1 nan") +
             Arguments{""})
        refused({"lightmap", "rig.toml", "-o", "out", "--altitude", altitudes}, "--altitude: ");
    for (const auto& [options, why] :
         Cases{{"-o out.exr --altitude 1:2:0.5", "--output: found out.exr; allowed: a folder"},
               {"-o out --altitude 2", "--output: found out; allowed: a name that ends in .exr"},
               {"-o out --altitude 1:2:0.5 --preview map.png", "--preview: found with 3 altitudes"},
               {"-o out --altitude 1:3:1 --export oplab", "found 3 altitudes; allowed: 4 or more"},
               {"-o out --altitude 0.02:0.1:0.04 --pitch 30",
                "strobe 'aft' is 0.2327 m below the sea floor"}})
        refused("lightmap rig.toml" + options, why);
}

}  // namespace
}  // namespace aphotic::lightmap_test
