// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic study and aphotic plan --plot, as a user runs them, on a small HabCam.
#include "support/command_test.h"
#include "support/has.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>

namespace aphotic::study_test {
namespace {

namespace fs = std::filesystem;

class Study : public CommandTest {
  protected:
    Study() {
        write_file(path("rig.toml"),
                   small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"));
    }
};

TEST_F(Study, MeasuresRecommendsAndGoesOnWhereItStopped) {
    const Arguments study("study rig.toml -o out --quick --json");
    const CommandResult first = aphotic(study);
    ASSERT_EQ(first.status, 0) << first.err;
    const auto json = nlohmann::json::parse(first.out);
    EXPECT_GE(json.at("measures").size(), 5U);
    for (const char* file : {"study.html", "study.csv", "study.json"}) {
        EXPECT_TRUE(fs::exists(path("out") / file)) << file;
    }
    // Nothing is measured twice: the times are the same to the last digit.
    const CommandResult again = aphotic(study);
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(again.out, first.out);
    EXPECT_EQ(again.err, "");
    // One measure gone: that one is taken again, and it alone.
    auto without = nlohmann::json::parse(first.out);
    auto& measures = without.at("measures");
    for (std::size_t i = 0; i < measures.size(); ++i) {
        if (measures[i].at("name") == "bands-6") measures.erase(i);
    }
    write_file(path("out") / "study.json", without.dump());
    const CommandResult resumed = aphotic(study);
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_TRUE(has(resumed.err, "6 equal bands"));
    EXPECT_FALSE(has(resumed.err, "fitted"));
    EXPECT_EQ(nlohmann::json::parse(resumed.out).at("measures").size(), measures.size() + 1);
    // A reference that is none is traced again.
    const fs::path reference = path("out") / "reference" / "image.exr";
    for (const std::string& half : {read_text_file(reference).substr(0, 700), std::string()}) {
        write_file(reference, half);
        const CommandResult traced = aphotic(study);
        EXPECT_EQ(traced.status, 0) << traced.err;
        EXPECT_NE(read_text_file(reference), half);
    }
}

TEST_F(Study, TriesWhatIsAskedFor) {
    const CommandResult asked =
        aphotic("study --fitted 3,3 --bands 4 --tolerance 0.01 rig.toml -o out");
    ASSERT_EQ(asked.status, 0) << asked.err;
    EXPECT_TRUE(has(asked.out, "3 settings"));
    for (const char* words : {"tolerance 0.01", "3 fitted wavelengths", "4 equal bands"})
        EXPECT_TRUE(has(asked.out, words));
    const CommandResult beyond = aphotic("study rig.toml --tolerance 1e-9 -o beyond");
    EXPECT_EQ(beyond.status, 2) << beyond.out;
    EXPECT_FALSE(fs::exists(path("beyond")));
}

// Errors are of the sum of floor and veil, settings' and the reference's alike: half floats' and
// the veil's own for fitted wavelengths.
TEST_F(Study, KnowsTheVeil) {
    std::string rig = text_of("rig.toml");
    rig.replace(rig.find("[400, 720]"), 10, "[400, 700]");
    const std::string clear = "absorption = \"pope-fry-1997\"";
    rig.replace(rig.find(clear), clear.size(), "type = \"jerlov-1C\"");
    write_file(path("rig.toml"), rig);
    const CommandResult run_of_it = aphotic("study rig.toml -o out --quick --json");
    ASSERT_EQ(run_of_it.status, 0) << run_of_it.err;
    for (const auto& measure : nlohmann::json::parse(run_of_it.out).at("measures")) {
        const auto name = measure.at("name").get<std::string>();
        if (name != "fitted-3") continue;
        EXPECT_LT(measure.at("max_error").get<double>(), 6e-4) << measure.dump(2);
    }
}

// Before objects a frame of fog tells where the veil ends; where the sky is in view, it is white.
TEST_F(Study, KnowsTheVeilBeforeObjectsAndTheSky) {
    put_small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/objects.toml", folder_.path());
    std::string rig = text_of("rig.toml");
    rig = std::regex_replace(rig, std::regex(R"(\npitch_deg\s*=[^\n]*)"), "\npitch_deg = 75.0");
    rig = std::regex_replace(
        rig, std::regex(R"(\n\[water\][^\[]*)"), "\n[water]\nscattering = \"sea-water\"\n\n");
    write_file(path("rig.toml"), rig);
    const CommandResult run_of_it = aphotic("study rig.toml -o out --quick");
    EXPECT_EQ(run_of_it.status, 0) << run_of_it.err;
}

TEST_F(Study, APlanIsAPictureToo) {
    const CommandResult plan = aphotic("plan rig.toml --plot plan.svg");
    ASSERT_EQ(plan.status, 0) << plan.err;
    EXPECT_GT(fs::file_size(path("plan.svg")), 10'000U);
    for (const char* file : {"plan.gif", "plan.png"})
        EXPECT_EQ(aphotic(fmt::format("plan rig.toml --plot {}", file)).status, 2) << file;
}

}  // namespace
}  // namespace aphotic::study_test
