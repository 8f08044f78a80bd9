// SPDX-License-Identifier: BSD-3-Clause
//
// Phil Harvey's exiftool, which shares no code with the libraries that we read and write tags by.
#pragma once

#include "base/atomic_file.h"
#include "plugin/process.h"
#include "support/temp_folder.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

// Exit status 127: there is no such program.
inline ProcessEnd run_exiftool(std::vector<std::string> arguments,
                               const std::filesystem::path& log) {
    constexpr double kTimeout_s = 60.0;
    arguments.insert(arguments.begin(), {"-c", R"(exec exiftool "$@")", "sh"});
    return run_process({.executable = "/bin/sh",
                        .arguments = arguments,
                        .folder = log.parent_path(),
                        .environment = {},
                        .log = log},
                       kTimeout_s);
}

inline bool has_exiftool() {
    const TempFolder folder;
    return run_exiftool({"-ver"}, folder.path() / "log").succeeded();
}

// With tags such as "-GPSLatitude=41.5".
inline void tag_by_exiftool(const std::filesystem::path& file, std::vector<std::string> tags) {
    const TempFolder folder;
    tags.insert(tags.end(), {"-q", "-m", "-overwrite_original", file.string()});
    const ProcessEnd end = run_exiftool(tags, folder.path() / "log");
    if (!end.succeeded()) throw std::runtime_error(read_text_file(folder.path() / "log"));
}

// All that it finds, numbers as numbers, by name with the group, such as GPS:GPSLatitude.
inline nlohmann::json tags_by_exiftool(const std::filesystem::path& file) {
    const TempFolder folder;
    const ProcessEnd end = run_exiftool({"-j", "-n", "-G1", file.string()}, folder.path() / "log");
    if (!end.succeeded()) throw std::runtime_error(read_text_file(folder.path() / "log"));
    return nlohmann::json::parse(read_text_file(folder.path() / "log")).at(0);
}

}  // namespace aphotic
