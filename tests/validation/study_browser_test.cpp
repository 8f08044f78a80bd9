// SPDX-License-Identifier: BSD-3-Clause
//
// A study's page in a real browser, as wide as on a desk and as narrow as on a phone: nothing on
// its console, nothing wider than the page, no label cut off or over another.
#include "report/html.h"
#include "support/browser.h"
#include "support/small_study.h"
#include "validation/study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace aphotic::study_browser_test {
namespace {

constexpr int kDesk_px = 1200;
constexpr int kPhone_px = 360;  // narrower than a browser's own window can be

// Errors that take as much room as errors can.
Study long_study() {
    Study study = small_study();
    for (StudyMeasure& measure : study.measures) {
        for (Comparison& channel : measure.channels) channel.max_error_on_edges = 4.44e-4;
    }
    return study;
}

// The page as it is in a frame of that width, and what a script outside sees of it in the title.
std::string measuring(const std::string& page, int width_px) {
    return fmt::format(R"(<html><head><title>-</title></head><body>
<iframe width="{}" height="900" style="border:0" srcdoc="{}"></iframe>)",
                       width_px,
                       escaped(page)) +
           R"(<script>
addEventListener('load', () => {
  const page = document.querySelector('iframe').contentDocument;
  const shown = [...page.querySelectorAll('figure svg')].filter(svg => svg.clientWidth > 0);
  const texts = shown.flatMap(svg => [...svg.querySelectorAll('text')]);
  const box = element => element.getBoundingClientRect();
  const cut = texts.filter(text => {
    const outer = box(text.ownerSVGElement);
    const inner = box(text);
    return inner.left < outer.left - 1 || inner.right > outer.right + 1 ||
           inner.top < outer.top - 1 || inner.bottom > outer.bottom + 1;
  });
  // A glyph's box is higher than the glyph.
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
                         Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 3;
  const covered = texts.filter((text, i) =>
    texts.slice(0, i).some(other => meet(box(text), box(other))));
  const scrolling = [...page.querySelectorAll('.wide')].filter(
    element => element.scrollWidth > element.clientWidth);
  const root = page.documentElement;
  const words = list => list.map(text => ' [' + text.textContent + ']').join('');
  document.title = `${shown.map(svg => svg.id)}, labels ` +
    `${shown[0].querySelectorAll('.label').length}, cut ${cut.length}${words(cut)}, ` +
    `covered ${covered.length}${words(covered)}, scrolling ${scrolling.length}, ` +
    `too wide ${root.scrollWidth - root.clientWidth}`;
});
</script></body></html>)";
}

class StudyInABrowser : public testing::Test {
  protected:
    void SetUp() override {
        if (!browser()) GTEST_SKIP() << "no chromium on the PATH";
    }
};

TEST_F(StudyInABrowser, LeavesTheConsoleEmpty) {
    const Seen seen = seen_by(*browser(), study_page(long_study()));
    EXPECT_EQ(seen.console, "");
    EXPECT_EQ(title_in(seen.page), "HabCam, strobes of finite size: accuracy against time");
    EXPECT_NE(seen.page.find("id=\"reading\""), std::string::npos) << "the last section";
}

// 24 settings have a label each.
TEST_F(StudyInABrowser, FitsADesk) {
    const Seen seen = seen_by(*browser(), measuring(study_page(long_study()), kDesk_px));
    EXPECT_EQ(title_in(seen.page),
              "study-plot, labels 24, cut 0, covered 0, scrolling 0, too wide 0");
    EXPECT_EQ(seen.console, "");
}

// Where the plot and the table scroll sideways, each by itself.
TEST_F(StudyInABrowser, FitsAPhone) {
    const Seen seen = seen_by(*browser(), measuring(study_page(long_study()), kPhone_px));
    EXPECT_EQ(title_in(seen.page),
              "study-plot, labels 24, cut 0, covered 0, scrolling 2, too wide 0");
    EXPECT_EQ(seen.console, "");
}

// That the checks above can fail.
TEST_F(StudyInABrowser, IsFoundOutWhenItIsBroken) {
    std::string page = study_page(long_study());
    page = replaced(page, "<h1>", "<h1 style=\"width: 1300px\">");
    page = replaced(page, ".label { font-size: 11px;", ".label { font-size: 40px;");
    const Seen seen = seen_by(*browser(), measuring(page, kDesk_px));
    const std::string title = title_in(seen.page);
    EXPECT_EQ(title.find("covered 0"), std::string::npos) << title;
    EXPECT_EQ(title.find("cut 0"), std::string::npos) << title;
    EXPECT_EQ(title.find("too wide 0"), std::string::npos) << title;
}

TEST_F(StudyInABrowser, ShowsHostileNamesAsText) {
    Study study = small_study();
    study.rig_title = "</title><script>document.title = 'owned'</script>";
    study.measures[0].setting.words = "<img src=x onerror=\"document.title = 'owned'\">";
    study.measures[1].setting.name = "</svg><script>document.title = 'owned'</script>";
    const Seen seen = seen_by(*browser(), study_page(study));
    EXPECT_TRUE(title_in(seen.page).starts_with("&lt;/title&gt;&lt;script&gt;"))
        << title_in(seen.page);
    EXPECT_EQ(seen.console, "");
}

}  // namespace
}  // namespace aphotic::study_browser_test
