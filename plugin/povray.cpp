// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/povray.h"

#include "base/disk_space.h"
#include "base/error.h"
#include "base/number.h"
#include "plugin/povray_log.h"
#include "plugin/process.h"
#include "plugin/scratch_folder.h"

#include <fmt/format.h>
#include <unistd.h>
#include <boost/process/search_path.hpp>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>
#include <utility>
#include <vector>

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
            "POV-Ray: no program '{}' ({}); install povray, or name it with --povray or "
            "APHOTIC_POVRAY",
            command,
            origin);
    }
    // Made absolute, since it will run in another folder.
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

struct Version {
    std::pair<int, int> number;
    std::string words;  // such as 3.7.0.10.unofficial
};

// "POV-Ray 3.7.0.10.unofficial" up to a blank, anywhere: complaints about its settings may precede
// it.
std::optional<Version> introduced_version(const std::string& printed) {
    static const std::regex kIntroduction(
        R"(POV-Ray ((\d{1,9})\.(\d{1,9})(?!\d)[^ \t\r\n]{0,80})(?=[ \t\r\n]|$))");
    std::smatch found;
    if (!std::regex_search(printed, found, kIntroduction)) return std::nullopt;
    return Version{.number = {*read_number<int>(found.str(2)), *read_number<int>(found.str(3))},
                   .words = found[1]};
}

// A line "Supported image formats: ... openexr ...".
bool lists_openexr(std::string_view printed) {
    std::istringstream lines{std::string(printed)};
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::vector<std::string> all{std::istream_iterator<std::string>(words), {}};
        if (all.size() < 3 || all[0] != "Supported" || all[1] != "image" || all[2] != "formats:") {
            continue;
        }
        if (std::ranges::find(all, "openexr") != all.end()) return true;
    }
    return false;
}

}  // namespace

PovRay povray_from(std::string_view printed) {
    // It identifies itself at the start, after one or two complaints; a program that prints
    // endlessly is not POV-Ray.
    constexpr std::size_t kIntroduction_bytes = 16384;
    printed = printed.substr(0, kIntroduction_bytes);
    const std::optional<Version> version = introduced_version(std::string(printed));
    if (!version) throw RunError("it does not identify itself as POV-Ray");
    if (version->number < kLeastVersion) {
        throw RunError("found version {}.{}; allowed: {}.{} or later",
                       version->number.first,
                       version->number.second,
                       kLeastVersion.first,
                       kLeastVersion.second);
    }
    return {.executable = {}, .version = version->words, .has_openexr = lists_openexr(printed)};
}

void require_openexr(const PovRay& povray, std::string_view why) {
    if (povray.has_openexr) return;
    throw RunError(
        "POV-Ray: {}: it was built without OpenEXR, {}", povray.executable.string(), why);
}

void require_format(const PovRay& povray, FrameFormat format) {
    if (format == FrameFormat::Exr)
        require_openexr(povray, "which frames need; --frame-format png16 does without");
}

std::string path_option(std::string_view option, const fs::path& path) {
    const bool is_readable = std::ranges::all_of(
        path.string(), [](unsigned char c) { return c >= ' ' && c < 0x7F && c != '"'; });
    if (!is_readable) {
        throw InputError(
            "{}: found a path with non-ASCII letters or a quotation mark; allowed: none, since "
            "POV-Ray cannot read them",
            path.string());
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
                                        .log = log},
                                       kProbeTimeoutS);
    try {
        if (!end.succeeded()) throw RunError("--version ended with " + end.words());
        PovRay povray = povray_from(read_log(log));
        povray.executable = executable;
        return povray;
    } catch (const RunError& error) {
        throw RunError("POV-Ray: {}: {}{}",
                       executable.string(),
                       error.what(),
                       words_of_full_disk(scratch.path()).c_str());
    }
}

}  // namespace aphotic
