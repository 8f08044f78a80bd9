// SPDX-License-Identifier: BSD-3-Clause
//
// The aphotic command as a user runs it: arguments in, exit status and both streams out.
#pragma once

#include "base/atomic_file.h"
#include "plugin/process.h"
#include "support/arguments.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr int kAnswerIsNo = 1;
inline constexpr int kBadInput = 2;
inline constexpr int kRunFailed = 3;

struct CommandResult {
    int status = 0;
    std::string out;
    std::string err;
    std::string line = {};  // as it was given
};

// folder: where it runs, and where relative paths start. environment: on top of ours.
inline CommandResult run_aphotic(const std::filesystem::path& folder,
                                 const Arguments& arguments,
                                 const std::map<std::string, std::string>& environment = {}) {
    constexpr double kTimeoutS = 1150.0;  // for what hangs: CTest's own limits end sooner
    const TempFolder streams;
    // A shell only to part the streams; the arguments do not pass through it.
    std::vector<std::string> all{
        "-c", R"(exec "$@" >"$0/out" 2>"$0/err")", streams.path().string()};
    all.emplace_back(APHOTIC_COMMAND);
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProcessEnd end = run_process({.executable = "/bin/sh",
                                        .arguments = all,
                                        .folder = folder,
                                        .environment = environment,
                                        .log = streams.path() / "shell"},
                                       kTimeoutS);
    return {.status = end.signal != 0 ? 128 + end.signal : end.exit_code,
            .out = read_text_file(streams.path() / "out"),
            .err = read_text_file(streams.path() / "err"),
            .line = fmt::format("aphotic {}", fmt::join(arguments, " "))};
}

// A program of the test's own, such as a POV-Ray that misbehaves.
inline std::filesystem::path write_script(const std::filesystem::path& file,
                                          const std::string& body) {
    write_file(file, "#!/bin/sh\n" + body);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file;
}

}  // namespace aphotic
