// SPDX-License-Identifier: BSD-3-Clause
//
// A design as a user asks for one: what it leaves, and what its numbers say.
#include "base/atomic_file.h"
#include "support/run_command.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::cli_design_test {
namespace {

namespace fs = std::filesystem;

class CommandDesign : public testing::Test {
  protected:
    void SetUp() override { put_small_scene(APHOTIC_SOURCE_DIR "/scenes/habcam.toml", at("")); }

    [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }

    [[nodiscard]] CommandResult design(const std::string& rig,
                                       const std::vector<std::string>& more) const {
        std::vector<std::string> all{
            "design", rig, "--altitude", "1.5,2.5", "--evaluations", "200"};
        all.insert(all.end(), more.begin(), more.end());
        return run_aphotic(folder_.path(), all);
    }

    [[nodiscard]] nlohmann::json numbers(const std::string& folder) const {
        return nlohmann::json::parse(read_text_file(at(folder) / "design.json"));
    }

    TempFolder folder_;
};

std::vector<std::string> tilts_into(const std::string& folder) {
    return {"--vary", "strobe.*.aim.tilt_deg", "-o", folder};
}

// A design that is designed again starts at the figures that the first ended with.
TEST_F(CommandDesign, LeavesARigThatIsAsEvenAsItSays) {
    const CommandResult run = design("rig.toml", tilts_into("out"));
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(fs::exists(at("out/report.html")));
    const nlohmann::json found = numbers("out");
    EXPECT_GT(found["design"]["worst"]["evenness"], found["start"]["worst"]["evenness"]);
    EXPECT_GE(found["design"]["worst"]["coverage"], found["start"]["worst"]["coverage"]);

    const CommandResult again = design("out/designed.toml", tilts_into("again"));
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(numbers("again")["start"]["worst"]["evenness"], found["design"]["worst"]["evenness"]);
}

TEST_F(CommandDesign, TheSameCommandGivesTheSameDesign) {
    for (const char* folder : {"one", "other"}) {
        const CommandResult run = design("rig.toml", tilts_into(folder));
        ASSERT_EQ(run.status, 0) << run.err;
    }
    EXPECT_EQ(read_text_file(at("one/designed.toml")), read_text_file(at("other/designed.toml")));
}

TEST_F(CommandDesign, NamesWhatMayVary) {
    const CommandResult run =
        design("rig.toml", {"--vary", "strobe.*.aim.tilt_dg", "-o", "out", "--json"});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find("rig.toml: --vary: found strobe.*.aim.tilt_dg; allowed: "),
              std::string::npos)
        << run.err;
    EXPECT_FALSE(fs::exists(at("out")));
}

}  // namespace
}  // namespace aphotic::cli_design_test
