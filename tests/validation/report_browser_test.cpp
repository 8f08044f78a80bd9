// SPDX-License-Identifier: BSD-3-Clause
//
// The report in a real browser, Debian's Chromium without a window: nothing on its console, every
// picture shown, nothing cut off or wider than the page.
#include "base/atomic_file.h"
#include "support/browser.h"
#include "support/small_report.h"
#include "support/temp_folder.h"
#include "validation/report.h"

#include <gtest/gtest.h>

#include <string>

namespace aphotic::report_browser_test {
namespace {

std::string page_of(const ValidationReport& report) {
    const TempFolder folder;
    write_validation_html(report, folder.path() / "report.html");
    return read_text_file(folder.path() / "report.html");
}

// A copy of the page that measures itself.
std::string measuring(const std::string& page) {
    return with_script(page, R"(
addEventListener('load', () => {
  const images = [...document.images];
  const shown = images.filter(i => i.complete && i.naturalWidth > 0 && i.clientWidth > 0);
  const cut = [...document.querySelectorAll('svg text')].filter(text => {
    const outer = text.ownerSVGElement.getBoundingClientRect();
    const inner = text.getBoundingClientRect();
    return inner.left < outer.left - 1 || inner.right > outer.right + 1 ||
           inner.top < outer.top - 1 || inner.bottom > outer.bottom + 1;
  });
  const root = document.documentElement;
  document.title = `images ${shown.length}/${images.length}, cut ${cut.length}` +
    cut.map(text => ' [' + text.textContent + ']').join('') +
    `, too wide ${root.scrollWidth - root.clientWidth}`;
});
)");
}

class ReportInABrowser : public testing::Test {
  protected:
    void SetUp() override {
        if (!browser()) GTEST_SKIP() << "no chromium on the PATH";
    }
};

TEST_F(ReportInABrowser, LeavesTheConsoleEmpty) {
    const Seen seen = seen_by(*browser(), page_of(small_report()));
    EXPECT_EQ(seen.console, "");
    EXPECT_EQ(title_in(seen.page), "HabCam, 2 m above sand: validation holds");
    EXPECT_NE(seen.page.find("id=\"made-with\""), std::string::npos) << "the last section";
}

TEST_F(ReportInABrowser, ShowsEveryPictureAndCutsNothingOff) {
    const Seen seen = seen_by(*browser(), measuring(page_of(small_report())));
    EXPECT_EQ(title_in(seen.page), "images 3/3, cut 0, too wide 0");
    EXPECT_EQ(seen.console, "");
}

// That the two checks above can fail.
TEST_F(ReportInABrowser, IsFoundOutWhenItIsBroken) {
    std::string page = measuring(page_of(small_report()));
    page = replaced(page, "base64,", "base64,AAAA");
    page = replaced(page, "</body>", "<script>no_such_function()</script></body>");
    const Seen seen = seen_by(*browser(), page);
    EXPECT_TRUE(title_in(seen.page).starts_with("images 2/3")) << title_in(seen.page);
    EXPECT_NE(seen.console.find("no_such_function"), std::string::npos) << seen.console;
}

TEST_F(ReportInABrowser, ShowsAHostileTitleAsText) {
    ValidationReport report = small_report();
    report.rig.title = "</title><script>document.title = 'owned'</script>";
    report.rig.toml = "# </pre><img src=x onerror=\"document.title = 'owned'\">\n";
    const Seen seen = seen_by(*browser(), page_of(report));
    EXPECT_TRUE(title_in(seen.page).starts_with("&lt;/title&gt;&lt;script&gt;"))
        << title_in(seen.page);
    EXPECT_EQ(seen.console, "");
    EXPECT_EQ(title_in(seen_by(*browser(), measuring(page_of(report))).page),
              "images 3/3, cut 0, too wide 0");
}

}  // namespace
}  // namespace aphotic::report_browser_test
