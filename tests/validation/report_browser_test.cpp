// SPDX-License-Identifier: BSD-3-Clause
//
// The report in a real browser, Debian's Chromium without a window: nothing on its console, every
// picture shown, nothing cut off or wider than the page.
#include "plugin/process.h"
#include "spectral/atomic_file.h"
#include "support/small_report.h"
#include "support/temp_folder.h"
#include "validation/report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <sstream>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> browser() {
    const char* path = std::getenv("PATH");
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
        std::istringstream folders(path == nullptr ? "" : path);
        for (std::string folder; std::getline(folders, folder, ':');) {
            if (fs::exists(fs::path(folder) / name)) return fs::path(folder) / name;
        }
    }
    return std::nullopt;
}

struct Seen {
    std::string page;     // as it stands when all has been loaded
    std::string console;  // lines of the browser's console
};

// No sandbox: it needs rights that a container or root does not have. The pages are our own.
Seen seen_by(const fs::path& program, const std::string& html) {
    constexpr double kTimeout_s = 90.0;
    const TempFolder folder;
    write_file(folder.path() / "report.html", html);
    const fs::path profile = folder.path() / "profile";
    const ProcessEnd end =
        run_process({.executable = "/bin/sh",
                     .arguments = {"-c",
                                   R"(exec "$@" >"$0/page" 2>"$0/log")",
                                   folder.path().string(),
                                   program.string(),
                                   "--headless=new",
                                   "--no-sandbox",
                                   "--disable-gpu",
                                   "--disable-dev-shm-usage",
                                   "--no-first-run",
                                   "--user-data-dir=" + profile.string(),
                                   "--window-size=1200,1000",
                                   "--enable-logging=stderr",
                                   "--dump-dom",
                                   "file://" + (folder.path() / "report.html").string()},
                     .folder = folder.path(),
                     .environment = {{"HOME", folder.path().string()}},
                     .log = folder.path() / "shell"},
                    kTimeout_s);
    EXPECT_TRUE(end.succeeded()) << end.words() << '\n' << read_text_file(folder.path() / "log");
    Seen seen{.page = read_text_file(folder.path() / "page"), .console = {}};
    std::istringstream log(read_text_file(folder.path() / "log"));
    for (std::string line; std::getline(log, line);) {
        if (line.find("CONSOLE") != std::string::npos) seen.console += line + '\n';
    }
    return seen;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::runtime_error("not on the page: " + what);
    return text.replace(at, what.size(), by);
}

std::string page_of(const ValidationReport& report) {
    const TempFolder folder;
    write_validation_html(report, folder.path() / "report.html");
    return read_text_file(folder.path() / "report.html");
}

// A copy of the page that measures itself; the page proper has no script and forbids them.
std::string measuring(const std::string& page) {
    const std::string script = R"(<script>
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
</script></body>)";
    return replaced(
        replaced(page, "default-src 'none'", "script-src 'unsafe-inline'"), "</body>", script);
}

std::string title_in(const std::string& page) {
    const std::size_t from = page.find("<title>") + 7;
    return page.substr(from, page.find("</title>") - from);
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
    report.rig.strobes[0].name = "<img src=x onerror=\"document.title = 'owned'\">";
    const Seen seen = seen_by(*browser(), page_of(report));
    EXPECT_TRUE(title_in(seen.page).starts_with("&lt;/title&gt;&lt;script&gt;"))
        << title_in(seen.page);
    EXPECT_EQ(seen.console, "");
    EXPECT_EQ(title_in(seen_by(*browser(), measuring(page_of(report))).page),
              "images 3/3, cut 0, too wide 0");
}

}  // namespace
}  // namespace aphotic
