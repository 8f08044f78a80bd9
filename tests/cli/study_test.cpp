// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic study and aphotic plan --plot, as a user runs them, on a small HabCam.
#include "support/command_test.h"
#include "support/has.h"
#include "support/scene_text.h"
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
    Study() { write_file(path("rig.toml"), small_scene("habcam.toml")); }
};

TEST_F(Study, MeasuresRecommendsAndGoesOnWhereItStopped) {
    const Arguments study("study rig.toml -o out --quick --json");
    const CommandResult first = done(study);
    const auto json = nlohmann::json::parse(first.out);
    EXPECT_GE(json.at("measures").size(), 5U);
    for (const char* file : {"study.html", "study.csv", "study.json"}) {
        EXPECT_TRUE(fs::exists(path("out") / file)) << file;
    }
    // Nothing is measured twice: the times are the same to the last digit.
    const CommandResult again = done(study);
    EXPECT_EQ(again.out, first.out);
    EXPECT_EQ(again.err, "");
    // One measure gone: that one is taken again, and it alone.
    auto without = nlohmann::json::parse(first.out);
    auto& measures = without.at("measures");
    for (std::size_t i = 0; i < measures.size(); ++i) {
        if (measures[i].at("name") == "bands-6") measures.erase(i);
    }
    write_file(path("out/study.json"), without.dump());
    const CommandResult resumed = done(study);
    EXPECT_TRUE(has(resumed.err, "6 equal bands"));
    EXPECT_FALSE(has(resumed.err, "fitted"));
    EXPECT_EQ(nlohmann::json::parse(resumed.out).at("measures").size(), measures.size() + 1);
    // A reference that is none is traced again.
    const fs::path reference = path("out/reference/image.exr");
    for (const std::string& half : {read_text_file(reference).substr(0, 700), std::string()}) {
        write_file(reference, half);
        done(study);
        EXPECT_NE(read_text_file(reference), half);
    }
}

TEST_F(Study, TriesWhatIsAskedFor) {
    const CommandResult asked =
        done("study --fitted 3,3 --bands 4 --tolerance 0.01 rig.toml -o out", "3 settings");
    for (const char* words : {"tolerance 0.01", "3 fitted wavelengths", "4 equal bands"})
        EXPECT_TRUE(has(asked.out, words));
    refused("study rig.toml --tolerance 1e-9 -o beyond", "");
}

// Errors are of the sum of floor and veil, settings' and the reference's alike: half floats' and
// the veil's own for fitted wavelengths.
TEST_F(Study, KnowsTheVeil) {
    const std::string rig = with(text_of("rig.toml"), {{"range_nm", "[400, 700]"}});
    write_file(path("rig.toml"),
               replaced(rig, "absorption = \"pope-fry-1997\"", "type = \"jerlov-1C\""));
    const auto json = json_by("study rig.toml -o out --quick --json");
    for (const auto& measure : json.at("measures")) {
        if (measure.at("name") != "fitted-3") continue;
        EXPECT_LT(measure.at("max_error").get<double>(), 6e-4) << measure.dump(2);
    }
}

// Before objects a frame of fog tells where the veil ends; where the sky is in view, it is white.
TEST_F(Study, KnowsTheVeilBeforeObjectsAndTheSky) {
    put_small_scene("objects.toml", home_);
    write_file(path("rig.toml"),
               std::regex_replace(with(text_of("rig.toml"), {{"pitch_deg", "75.0"}}),
                                  std::regex(R"(\n\[water\][^\[]*)"),
                                  "\n[water]\nscattering = \"sea-water\"\n\n"));
    done("study rig.toml -o out --quick");
}

TEST_F(Study, APlanIsAPictureToo) {
    done("plan rig.toml --plot plan.svg");
    EXPECT_GT(fs::file_size(path("plan.svg")), 10'000U);
    for (const char* file : {"plan.gif", "plan.png"})
        EXPECT_EQ(aphotic(fmt::format("plan rig.toml --plot {}", file)).status, 2) << file;
}

}  // namespace
}  // namespace aphotic::study_test
