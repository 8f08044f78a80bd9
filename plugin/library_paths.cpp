// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/library_paths.h"

#include "base/atomic_file.h"

#include <cstdlib>
#include <optional>
#include <regex>
#include <sstream>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

std::optional<std::string> variable(const char* name) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') return std::nullopt;
    return std::string(value);
}

}  // namespace

std::vector<std::string> library_paths_in(const std::string& ini) {
    static const std::regex kLine(R"re(\s*Library_Path\s*=\s*(?:"([^"]*)"|([^;]*?))\s*(;.*)?)re",
                                  std::regex::icase);
    // No path is longer, and matching a line uses stack for each of its letters.
    constexpr std::size_t kMostLetters = 8192;
    std::vector<std::string> paths;
    std::istringstream lines(ini);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (line.size() > kMostLetters) continue;
        if (!std::regex_match(line, match, kLine)) continue;
        const std::string path = match[1].matched ? match[1] : match[2];
        if (!path.empty()) paths.push_back(path);
    }
    return paths;
}

std::vector<std::string> library_paths(const fs::path& folder, const std::string& version) {
    const std::string series = version.substr(0, version.find('.', version.find('.') + 1));
    std::vector<fs::path> places;
    if (const auto named = variable("POVINI")) places.emplace_back(*named);
    places.push_back(folder / "povray.ini");
    if (const auto home = variable("HOME")) {
        places.push_back(fs::path(*home) / ".povray" / series / "povray.ini");
    }
    places.push_back(fs::path("/etc/povray") / series / "povray.ini");
    for (const fs::path& place : places) {
        std::error_code ignored;
        if (fs::is_regular_file(place, ignored)) return library_paths_in(read_text_file(place));
    }
    return {};
}

}  // namespace aphotic
