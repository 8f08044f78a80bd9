// SPDX-License-Identifier: BSD-3-Clause
//
// A page in a real browser, Debian's Chromium without a window, and what it says of it.
#pragma once

#include "base/atomic_file.h"
#include "plugin/process.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

namespace aphotic {

inline std::optional<std::filesystem::path> browser() {
    const char* path = std::getenv("PATH");
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
        std::istringstream folders(path == nullptr ? "" : path);
        for (std::string folder; std::getline(folders, folder, ':');) {
            const std::filesystem::path program = std::filesystem::path(folder) / name;
            if (std::filesystem::exists(program)) return program;
        }
    }
    return std::nullopt;
}

struct Seen {
    std::string page;     // as it stands when all has been loaded
    std::string console;  // lines of the browser's console
};

// No sandbox: it needs rights that a container or root does not have. The pages are our own.
inline Seen seen_by(const std::filesystem::path& program, const std::string& html) {
    constexpr double kTimeout_s = 90.0;
    const TempFolder folder;
    write_file(folder.path() / "report.html", html);
    const std::filesystem::path profile = folder.path() / "profile";
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

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::runtime_error("not on the page: " + what);
    return text.replace(at, what.size(), by);
}

// A copy of the page with a script; the page proper has none and forbids them.
inline std::string with_script(const std::string& page, const std::string& script) {
    return replaced(replaced(page, "default-src 'none'", "script-src 'unsafe-inline'"),
                    "</body>",
                    "<script>" + script + "</script></body>");
}

inline std::string title_in(const std::string& page) {
    const std::size_t from = page.find("<title>") + 7;
    return page.substr(from, page.find("</title>") - from);
}

}  // namespace aphotic
