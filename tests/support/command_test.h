// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of the command in a folder of their own.
#pragma once

#include "support/has.h"
#include "support/run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

// What to give the command, and words of what it says then.
using Cases = std::vector<std::pair<Arguments, std::string>>;

class CommandTest : public testing::Test {
  protected:
    // In that folder of the test's own.
    explicit CommandTest(const std::string& folder = "")
        : home_(folder.empty() ? folder_.path() : folder_.path() / folder) {
        std::filesystem::create_directories(home_);
    }

    [[nodiscard]] std::filesystem::path path(const std::string& name) const { return home_ / name; }
    [[nodiscard]] std::string text_of(const std::string& name) const {
        return read_text_file(path(name));
    }
    [[nodiscard]] nlohmann::json json_in(const std::string& name) const {
        return nlohmann::json::parse(text_of(name));
    }

    // Run in the folder.
    [[nodiscard]] CommandResult aphotic(
        const Arguments& arguments,
        const std::map<std::string, std::string>& environment = {}) const {
        return run_aphotic(home_, arguments, environment);
    }

    // Another program there, what it prints in the file log.
    [[nodiscard]] ProcessEnd by(const std::string& program,
                                const Arguments& arguments,
                                const std::map<std::string, std::string>& environment = {}) const {
        constexpr double kTimeout_s = 600.0;  // for what hangs
        return run_process({.executable = program,
                            .arguments = arguments,
                            .folder = home_,
                            .environment = environment,
                            .log = path("log")},
                           kTimeout_s);
    }
    [[nodiscard]] ProcessEnd by_shell(const std::string& script) const {
        return by("/bin/sh", {"-c", script});
    }

    // It does what it is asked to, and says so in these words.
    static CommandResult done(const CommandResult& run,
                              const std::string& words = "",
                              int status = 0) {
        EXPECT_EQ(run.status, status) << run.line << "\n" << run.out << run.err;
        EXPECT_TRUE(has(run.out, words)) << run.line;
        return run;
    }
    CommandResult done(const Arguments& arguments,
                       const std::string& words = "",
                       int status = 0) const {
        return done(aphotic(arguments), words, status);
    }
    // What it says with --json.
    static nlohmann::json json_by(const CommandResult& run, int status = 0) {
        return nlohmann::json::parse(done(run, "", status).out);
    }
    [[nodiscard]] nlohmann::json json_by(const Arguments& arguments, int status = 0) const {
        return json_by(aphotic(arguments), status);
    }

    // It says why it does not, or what is wrong with the line, and nothing else.
    static CommandResult refused(const CommandResult& run,
                                 const std::string& why,
                                 int status = kBadInput) {
        EXPECT_EQ(run.status, status) << run.line << "\n" << run.err;
        EXPECT_TRUE(run.err.starts_with("aphotic") || has(run.err, "\nRun with --help for more"))
            << run.line << "\n"
            << run.err;
        EXPECT_TRUE(has(run.err, why)) << run.line;
        EXPECT_EQ(run.out, "") << run.line;
        return run;
    }
    // Nor does it write a file or folder, or take one away.
    CommandResult refused(const Arguments& arguments,
                          const std::string& why,
                          int status = kBadInput) const {
        const std::set<std::string> before = names();
        const CommandResult run = refused(aphotic(arguments), why, status);
        EXPECT_EQ(names(), before) << run.line;
        return run;
    }

    // Every file below, with its bytes.
    [[nodiscard]] std::map<std::string, std::string> files_in(const std::string& folder) const {
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path(folder))) {
            if (!entry.is_regular_file()) continue;
            const auto name = std::filesystem::relative(entry.path(), path(folder));
            files[name.string()] = read_text_file(entry.path());
        }
        return files;
    }
    // Of every file and folder that there is.
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(home_))
            all.insert(entry.path().string());
        return all;
    }

    TempFolder folder_;
    std::filesystem::path home_;
};

}  // namespace aphotic
