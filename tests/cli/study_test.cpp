// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic study and aphotic plan --plot, as a user runs them, on a small HabCam.
#include "support/run_command.h"
#include "support/small_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::study_test {
namespace {

namespace fs = std::filesystem;

class Study : public testing::Test {
  protected:
    Study() {
        write_file(folder_.path() / "rig.toml",
                   small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"));
    }

    CommandResult run(const std::vector<std::string>& arguments) {
        return run_aphotic(folder_.path(), arguments);
    }

    TempFolder folder_;
};

TEST_F(Study, MeasuresRecommendsAndGoesOnWhereItStopped) {
    const std::vector<std::string> study{"study", "rig.toml", "-o", "out", "--quick", "--json"};
    const CommandResult first = run(study);
    ASSERT_EQ(first.status, 0) << first.err;
    const auto json = nlohmann::json::parse(first.out);
    EXPECT_GE(json.at("measures").size(), 5U);
    for (const char* file : {"study.html", "study.csv", "study.json"}) {
        EXPECT_TRUE(fs::exists(folder_.path() / "out" / file)) << file;
    }
    // Nothing is measured twice: the times are the same to the last digit.
    const CommandResult again = run(study);
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(again.out, first.out);
    EXPECT_EQ(again.err, "");
    // One measure gone: that one is taken again, and it alone.
    fs::remove(folder_.path() / "out" / "settings" / "bands-6.json");
    const CommandResult resumed = run(study);
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_NE(resumed.err.find("6 equal bands"), std::string::npos) << resumed.err;
    EXPECT_EQ(resumed.err.find("fitted"), std::string::npos) << resumed.err;
    // A reference that is none is traced again.
    const fs::path reference = folder_.path() / "out" / "reference" / "image.exr";
    for (const std::string& half : {read_text_file(reference).substr(0, 700), std::string()}) {
        write_file(reference, half);
        const CommandResult traced = run(study);
        EXPECT_EQ(traced.status, 0) << traced.err;
        EXPECT_NE(read_text_file(reference), half);
    }
}

TEST_F(Study, APlanIsAPictureToo) {
    const CommandResult plan = run({"plan", "rig.toml", "--plot", "plan.svg"});
    ASSERT_EQ(plan.status, 0) << plan.err;
    EXPECT_GT(fs::file_size(folder_.path() / "plan.svg"), 10'000U);
    for (const char* file : {"plan.gif", "plan.png"})
        EXPECT_EQ(run({"plan", "rig.toml", "--plot", file}).status, 2) << file;
}

}  // namespace
}  // namespace aphotic::study_test
