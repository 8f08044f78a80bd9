// SPDX-License-Identifier: BSD-3-Clause
//
// The page of a corrected survey in a real browser, as wide as on a desk and as narrow as on a
// phone: nothing on its console, every picture shown, nothing wider than the page.
#include "report/html.h"
#include "support/browser.h"
#include "support/corrected_survey.h"
#include "support/has.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace aphotic::correction_page_browser_test {
namespace {

constexpr int kDesk_px = 1200;
constexpr int kPhone_px = 360;

// The page in a frame of that width, and what a script outside sees of it in the title.
std::string measuring(const std::string& page, int width_px) {
    return fmt::format(R"(<html><head><title>-</title></head><body>
<iframe width="{}" height="900" style="border:0" srcdoc="{}"></iframe>)",
                       width_px,
                       escaped(page)) +
           R"(<script>
addEventListener('load', () => {
  const page = document.querySelector('iframe').contentDocument;
  const images = [...page.images];
  const shown = images.filter(i => i.complete && i.naturalWidth > 0 && i.clientWidth > 0);
  const box = element => element.getBoundingClientRect();
  const cut = [...page.querySelectorAll('.plot text')].filter(text => {
    const outer = box(text.ownerSVGElement);
    return box(text).left < outer.left - 1 || box(text).right > outer.right + 1 ||
           box(text).top < outer.top - 1 || box(text).bottom > outer.bottom + 1;
  });
  const columns = getComputedStyle(page.querySelector('.sheet')).gridTemplateColumns;
  const root = page.documentElement;
  document.title = `images ${shown.length}/${images.length}, columns ` +
    `${columns.split(' ').length}, cut ${cut.length}` +
    cut.map(text => ' [' + text.textContent + ']').join('') +
    `, too wide ${root.scrollWidth - root.clientWidth}`;
});
</script></body></html>)";
}

class CorrectionPageInABrowser : public testing::Test {
  protected:
    void SetUp() override {
        if (!browser()) GTEST_SKIP() << "no chromium on the PATH";
    }
    CorrectedSurvey survey_;
};

TEST_F(CorrectionPageInABrowser, LeavesTheConsoleEmptyAndNamesAsText) {
    const Seen seen = seen_by(*browser(), survey_.page);
    EXPECT_EQ(seen.console, "");
    EXPECT_TRUE(title_in(seen.page).starts_with("Correction: Sled of &lt;script&gt;"))
        << title_in(seen.page);
}

TEST_F(CorrectionPageInABrowser, FitsADesk) {
    const Seen seen = seen_by(*browser(), measuring(survey_.page, kDesk_px));
    EXPECT_EQ(title_in(seen.page), "images 8/8, columns 3, cut 0, too wide 0");
    EXPECT_EQ(seen.console, "");
}

TEST_F(CorrectionPageInABrowser, FitsAPhone) {
    const Seen seen = seen_by(*browser(), measuring(survey_.page, kPhone_px));
    EXPECT_EQ(title_in(seen.page), "images 8/8, columns 1, cut 0, too wide 0");
}

// That the checks above can fail.
TEST_F(CorrectionPageInABrowser, IsFoundOutWhenItIsBroken) {
    std::string page = replaced(survey_.page, "base64,", "base64,AAAA");
    page = replaced(page, "<h1>", "<h1 style=\"width: 1300px\">");
    const std::string title = title_in(seen_by(*browser(), measuring(page, kDesk_px)).page);
    EXPECT_TRUE(title.starts_with("images 7/8")) << title;
    EXPECT_FALSE(has(title, "too wide 0"));
}

}  // namespace
}  // namespace aphotic::correction_page_browser_test
