// SPDX-License-Identifier: BSD-3-Clause
//
// Pages in a real browser, as wide as on a desk and as narrow as on a phone: nothing on its
// console, every picture shown, no label cut off, nothing wider than the page, and hostile names as
// text.
#include "base/atomic_file.h"
#include "report/html.h"
#include "support/browser.h"
#include "support/corrected_survey.h"
#include "support/has.h"
#include "support/small_report.h"
#include "validation/comparison_page.h"
#include "validation/report.h"
#include "validation/study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace aphotic::page_browser_test {
namespace {

constexpr int kDesk_px = 1200;
constexpr int kPhone_px = 360;
const std::string kEvil = "</title></pre><script>document.title = 'owned'</script>";

std::string validation_page() {
    ValidationReport report = small_report();
    report.rig.title = kEvil;
    report.rig.toml = "# </pre><img src=x onerror=\"document.title = 'owned'\">\n";
    const TempFolder folder;
    write_validation_html(report, folder.path() / "report.html");
    return read_text_file(folder.path() / "report.html");
}

// A bright middle, and an image that is off by a wave of up to 1e-3 and in one pixel by 0.02.
ComparedChannel channel_of(const std::string& name, std::size_t worst) {
    constexpr int kWidth_px = 48;
    constexpr int kHeight_px = 32;
    ComparedChannel channel{
        .comparison = {}, .black = 1e-6, .image = {}, .reference = {}, .marks = {}};
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column) {
            const double level = std::exp(-std::hypot(column - 24, row - 16) / 20.0);
            channel.reference.push_back(static_cast<float>(level));
            channel.image.push_back(
                static_cast<float>(level * (1.0 + 1e-3 * std::sin(column / 5.0))));
        }
    }
    channel.image[worst] *= 1.02F;
    channel.comparison =
        compare_planes(name,
                       channel.image,
                       std::vector<double>(channel.reference.begin(), channel.reference.end()),
                       kWidth_px,
                       {},
                       channel.black,
                       6e-4);
    return channel;
}

std::string comparison_page() {
    return comparison_html({.image = kEvil,
                            .reference = "theirs.exr",
                            .width_px = 48,
                            .height_px = 32,
                            .black = 1e-6,
                            .channels = {channel_of("R", 100), channel_of(kEvil, 1000)},
                            .only_in_image = {"S0.470,000000nm"},
                            .left_aside = {"A"}});
}

std::string study_page() {
    Study study{.rig_title = kEvil, .width_px = 1360, .height_px = 1024, .povray_version = kEvil};
    for (const int count : {3, 6, 12, 36, 72}) {
        study.measures.push_back({.setting = {.name = fmt::format("bands-{}", count),
                                              .words = kEvil,
                                              .equal_bands = count > 6},
                                  .wavelengths = static_cast<std::size_t>(count),
                                  .frames = 1,
                                  .render_s = count / 3.0,
                                  .max_error = 1.0 / count});
    }
    const TempFolder folder;
    write_study(study, folder.path());
    return read_text_file(folder.path() / "study.html");
}

std::string correction_page() {
    return CorrectedSurvey().page;
}

struct Shown {
    const char* name;
    std::string (*page)();
    int pictures;
    int rings;
};

void PrintTo(const Shown& shown, std::ostream* out) {
    *out << shown.name;
}

// The page in a frame of that width, and what a script outside sees of it in the title.
std::string measuring(const std::string& page, int width_px) {
    return fmt::format(R"(<html><head><title>-</title></head><body>
<iframe width="{}" height="900" style="border:0" srcdoc="{}"></iframe>)",
                       width_px,
                       escaped(page)) +
           read_text_file(APHOTIC_SOURCE_DIR "/tests/report/measuring.html");
}

class PageInABrowser : public testing::TestWithParam<Shown> {
  protected:
    void SetUp() override {
        if (!browser()) GTEST_SKIP() << "no chromium on the PATH";
    }
};

TEST_P(PageInABrowser, LeavesTheConsoleEmptyAndNamesAsText) {
    const Seen seen = seen_by(*browser(), GetParam().page());
    EXPECT_EQ(seen.console, "");
    EXPECT_NE(title_in(seen.page).find("&lt;script&gt;"), std::string::npos) << title_in(seen.page);
}

TEST_P(PageInABrowser, FitsADeskAndAPhone) {
    const std::string page = GetParam().page();
    for (const int width_px : {kDesk_px, kPhone_px}) {
        const Seen seen = seen_by(*browser(), measuring(page, width_px));
        EXPECT_EQ(title_in(seen.page),
                  fmt::format("images {0}/{0}, rings {1}, cut 0, ids twice 0, too wide 0",
                              GetParam().pictures,
                              GetParam().rings))
            << width_px;
        EXPECT_EQ(seen.console, "");
    }
}

INSTANTIATE_TEST_SUITE_P(All,
                         PageInABrowser,
                         testing::Values(Shown{"validation", validation_page, 3, 1},
                                         Shown{"comparison", comparison_page, 6, 2},
                                         Shown{"study", study_page, 0, 0},
                                         Shown{"correction", correction_page, 8, 0}));

// That the checks above can fail.
TEST(BrokenPageInABrowser, IsFoundOut) {
    if (!browser()) GTEST_SKIP() << "no chromium on the PATH";
    std::string page = replaced(validation_page(), "base64,", "base64,AAAA");
    page = replaced(page, "<h1>", "<h1 id=\"rig\" style=\"width: 1300px\">");
    page = replaced(page, "svg .axis { font-size: 13px; }", "svg .axis { font-size: 90px; }");
    const std::string title = title_in(seen_by(*browser(), measuring(page, kDesk_px)).page);
    EXPECT_TRUE(title.starts_with("images 2/3")) << title;
    EXPECT_TRUE(has(title, "ids twice 1"));
    for (const char* held : {"cut 0", "too wide 0"}) EXPECT_FALSE(has(title, held));
    const Seen seen = seen_by(*browser(), with_script(validation_page(), "no_such_function();"));
    EXPECT_TRUE(has(seen.console, "no_such_function"));
}

}  // namespace
}  // namespace aphotic::page_browser_test
