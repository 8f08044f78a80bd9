// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/correction_page.h"

#include "support/corrected_survey.h"
#include "support/page.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace aphotic::correction_page_test {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

class CorrectionPage : public testing::Test {
  protected:
    CorrectedSurvey survey_;
    std::string words_ = words_of(survey_.page);
};

TEST_F(CorrectionPage, ShowsEveryImageTwiceAndLeavesNoOtherFile) {
    EXPECT_EQ(count_of(survey_.page, "data:image/jpeg;base64,"), 2U * 4U);
    for (const char* caption : {"a, 1.90", "b, 2.00", "c, 2.10", "high, 3.50"}) {
        const std::string name(caption, std::string(caption).find(','));
        EXPECT_TRUE(contains(words_, name)) << caption;
    }
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& file :
         std::filesystem::directory_iterator(survey_.raw.path("out"))) {
        ++files;
    }
    EXPECT_EQ(files, 4U + 3U) << "images, correction.json, corrected.jsonl, report.html";
}

// The gain is that of CorrectionRun.DividesEachImageByTheLightOfItsPose.
TEST_F(CorrectionPage, TellsWhatWasDoneAndWhatNot) {
    EXPECT_TRUE(contains(words_, "4 images corrected, 1 skipped")) << words_;
    EXPECT_TRUE(contains(words_, "0.1 red, 0.1 green, 0.1 blue"));
    EXPECT_TRUE(contains(words_, "&lt;b&gt;x.exr"));
    EXPECT_TRUE(contains(words_, "saturated"));
    EXPECT_TRUE(contains(words_, "title = &quot;&lt;i&gt;&quot;"));
    EXPECT_TRUE(contains(words_, "altitude (m)"));
}

TEST_F(CorrectionPage, IsWellFormedAndHoldsNamesAsText) {
    EXPECT_EQ(first_unbalanced(survey_.page), "");
    EXPECT_FALSE(contains(survey_.page, "<script>"));
    EXPECT_FALSE(contains(survey_.page, "<b>x"));
}

}  // namespace
}  // namespace aphotic::correction_page_test
