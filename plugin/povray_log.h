// SPDX-License-Identifier: BSD-3-Clause
//
// What POV-Ray prints: its messages are wrapped at 80 columns, what goes on is indented with one
// blank, and progress overwrites itself.
#pragma once

#include <string>
#include <vector>

namespace aphotic {

// Its messages, one an entry, unwrapped.
[[nodiscard]] std::vector<std::string> statements_in_log(const std::string& log);

// What it says went wrong: the error with its file and line.
[[nodiscard]] std::string error_in_log(const std::string& log);

}  // namespace aphotic
