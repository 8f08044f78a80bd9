// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/povray.h"

#include "plugin/povray_log.h"
#include "plugin/process.h"
#include "plugin/scratch_folder.h"
#include "spectral/error.h"

#include <fmt/format.h>
#include <unistd.h>
#include <boost/process/search_path.hpp>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr double kProbeTimeoutS = 30.0;
constexpr std::pair kLeastVersion{3, 7};

fs::path located(const std::string& command, const std::string& origin) {
    const bool is_path = command.find('/') != std::string::npos;
    const fs::path path =
        is_path ? fs::path(command) : fs::path(boost::process::search_path(command).string());
    if (path.empty() || ::access(path.c_str(), X_OK) != 0 || fs::is_directory(path)) {
        throw RunError(
            fmt::format("POV-Ray: no program '{}' ({}); install povray, or name it with "
                        "--povray or APHOTIC_POVRAY",
                        command,
                        origin));
    }
    // It will run in another folder.
    return fs::absolute(path);
}

fs::path find_executable(const std::string& named) {
    if (!named.empty()) return located(named, "named by the option");
    const char* variable = std::getenv("APHOTIC_POVRAY");
    if (variable != nullptr && *variable != '\0') {
        return located(variable, "named by APHOTIC_POVRAY");
    }
    return located("povray", "looked for on PATH");
}

}  // namespace

std::string version_from(std::string_view printed) {
    const std::string text(printed);
    std::smatch version;
    if (!std::regex_search(text, version, std::regex(R"(POV-Ray (\d+)\.(\d+)(\S*))"))) {
        throw RunError("it does not introduce itself as POV-Ray");
    }
    const std::pair found{std::stoi(version[1]), std::stoi(version[2])};
    if (found < kLeastVersion) {
        throw RunError(fmt::format("found version {}.{}; allowed: {}.{} or later",
                                   found.first,
                                   found.second,
                                   kLeastVersion.first,
                                   kLeastVersion.second));
    }
    if (!std::regex_search(text, std::regex(R"(\n *Supported image formats:[^\n]*\bopenexr\b)"))) {
        throw RunError("it was built without OpenEXR, in which frames are written");
    }
    return version[1].str() + "." + version[2].str() + version[3].str();
}

std::string path_option(std::string_view option, const fs::path& path) {
    const bool is_readable = std::ranges::all_of(
        path.string(), [](unsigned char c) { return c >= ' ' && c < 0x7F && c != '"'; });
    if (!is_readable) {
        throw InputError(
            fmt::format("{}: found a path with letters beyond ASCII or a quotation mark; "
                        "allowed: none, for POV-Ray cannot read them",
                        path.string()));
    }
    return fmt::format("{}\"{}\"", option, path.string());
}

PovRay find_povray(const std::string& named) {
    const fs::path executable = find_executable(named);
    const ScratchFolder scratch;
    const fs::path log = scratch.path() / "version.txt";
    const ProcessEnd end = run_process({.executable = executable,
                                        .arguments = {"--version"},
                                        .folder = scratch.path(),
                                        .environment = {},
                                        .log = log},
                                       kProbeTimeoutS);
    try {
        if (!end.succeeded()) throw RunError("--version ended with " + end.words());
        return {.executable = executable, .version = version_from(read_log(log))};
    } catch (const RunError& error) {
        throw RunError(fmt::format("POV-Ray: {}: {}", executable.string(), error.what()));
    }
}

}  // namespace aphotic
