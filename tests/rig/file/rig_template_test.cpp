// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_template.h"

#include "base/atomic_file.h"
#include "rig/file/rig_reader.h"
#include "rig/plausibility.h"
#include "support/scene_text.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace aphotic::rig_template_test {
namespace {

std::vector<std::string> texts_of(const std::vector<UnmeasuredLine>& lines) {
    std::vector<std::string> texts;
    for (const UnmeasuredLine& line : lines) texts.push_back(line.text);
    return texts;
}

TEST(RigTemplate, IsARigThatNothingIsDoubtfulAbout) {
    for (const std::string& name : template_names()) {
        const TempFolder folder;
        const RigTemplate chosen = rig_template(name);
        write_text_file(folder.path() / "rig.toml", chosen.rig);
        for (const auto& [file, text] : chosen.files) write_text_file(folder.path() / file, text);
        EXPECT_TRUE(doubts_of(read_rig(folder.path() / "rig.toml")).empty()) << name;
    }
}

// As many as `grep -c "# measure:"` counts in the scene, at the lines where they stand.
TEST(RigTemplate, NamesEveryMarkedLine) {
    const std::string rig = rig_template("auv").rig;
    const auto unmeasured = unmeasured_lines(rig);
    EXPECT_EQ(unmeasured.size(), 17U);
    std::istringstream lines(rig);
    int number = 0;
    auto next = unmeasured.begin();
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (!has(line, "# measure:")) continue;
        ASSERT_NE(next, unmeasured.end());
        EXPECT_EQ(next->line, number);
        EXPECT_TRUE(line.starts_with(next->text)) << line;
        ++next;
    }
    EXPECT_EQ(next, unmeasured.end());
}

TEST(RigTemplate, AMeasuredValueIsTheTemplatesNoMore) {
    const std::string rig = rig_template("led").rig;
    const auto before = texts_of(unmeasured_lines(rig));
    const auto measured = texts_of(unmeasured_lines(replaced(rig, "= 5.86 ", "= 5.9")));
    EXPECT_EQ(measured.size() + 1, before.size());
    EXPECT_EQ(std::ranges::count(measured, "pixel_pitch_um  = 5.86"), 0);
}

// The template's guess happens to be right.
TEST(RigTemplate, NorIsOneWithoutItsMark) {
    const std::string rig = rig_template("led").rig;
    const std::string mark = "  # measure: the sensor's data sheet";
    EXPECT_EQ(unmeasured_lines(replaced(rig, mark, "")).size() + 1, unmeasured_lines(rig).size());
}

// A fit does not measure the camera's response.
TEST(RigTemplate, AFittedRigHasTheGuessesThatAreLeft) {
    const std::string rig = rig_template("led").rig;
    EXPECT_EQ(unmeasured_lines("# By aphotic fit\n" + rig).size(), unmeasured_lines(rig).size());
}

TEST(RigTemplate, OtherRigsHaveNoGuesses) {
    EXPECT_TRUE(unmeasured_lines(scene_text("habcam.toml")).empty());
    EXPECT_TRUE(unmeasured_lines("# From `aphotic init --like nothing`\n").empty());
    EXPECT_TRUE(unmeasured_lines("").empty());
}

}  // namespace
}  // namespace aphotic::rig_template_test
