// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/povray_log.h"

#include "base/error.h"
#include "base/number.h"
#include "plugin/process.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace aphotic {

std::string read_log(const std::filesystem::path& log) {
    std::ifstream in(log, std::ios::binary | std::ios::ate);
    const std::streamoff size = in.tellg();
    if (size < 0) throw RunError("{}: cannot be read", log.string());
    std::string text(std::min(static_cast<std::size_t>(size), std::size_t{kMostLogBytes}), '\0');
    in.seekg(0);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    return text;
}

std::vector<std::string> statements_in_log(const std::string& log) {
    std::istringstream lines(log);
    std::vector<std::string> statements;
    for (std::string line; std::getline(lines, line);) {
        line = line.substr(line.rfind('\r') + 1);
        if (line.starts_with(' ') && !line.starts_with("  ") && !statements.empty()) {
            statements.back() += line;
        } else {
            statements.push_back(line);
        }
    }
    return statements;
}

std::string error_in_log(const std::string& log) {
    constexpr std::size_t kMostLetters = 2000;
    std::string said;
    for (const std::string& statement : statements_in_log(log)) {
        if (statement.find("rror") == std::string::npos &&
            statement.find("Problem with option") == std::string::npos) {
            continue;
        }
        if (!said.empty()) said += '\n';
        said += statement;
        if (said.size() > kMostLetters) return said.substr(0, kMostLetters) + " ...";
    }
    return said;
}

double share_in_log(std::string_view log) {
    constexpr std::string_view kBefore = "pixels (";
    constexpr std::string_view kBehind = "%)";
    constexpr int kWhole = 100;
    double share = 0.0;
    for (auto at = log.find(kBefore); at != std::string_view::npos; at = log.find(kBefore, at)) {
        at += kBefore.size();
        std::string_view rest = log.substr(at);
        const auto percent = read_leading_number<int>(rest);
        if (!percent || !rest.starts_with(kBehind)) continue;
        if (*percent >= 0 && *percent <= kWhole) share = static_cast<double>(*percent) / kWhole;
    }
    return share;
}

}  // namespace aphotic
