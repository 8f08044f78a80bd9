// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/povray_log.h"

#include <sstream>

namespace aphotic {

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
    std::string said;
    for (const std::string& statement : statements_in_log(log)) {
        if (statement.find("rror") == std::string::npos &&
            statement.find("Problem with option") == std::string::npos) {
            continue;
        }
        if (!said.empty()) said += '\n';
        said += statement;
    }
    return said;
}

}  // namespace aphotic
