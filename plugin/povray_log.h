// SPDX-License-Identifier: BSD-3-Clause
//
// POV-Ray's output: its messages are wrapped at 80 columns, continuation lines are indented by one
// blank, and progress overwrites itself.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// A log as written, up to the size at which POV-Ray is stopped (plugin/process.h).
[[nodiscard]] std::string read_log(const std::filesystem::path& log);

// Its messages, one per entry, unwrapped.
[[nodiscard]] std::vector<std::string> statements_in_log(const std::string& log);

// POV-Ray's error with its file and line. Only the first few errors if there are many.
[[nodiscard]] std::string error_in_log(const std::string& log);

// The last progress reported, from 0 to 1: "(27%)". 0 if there is none, or an impossible one.
[[nodiscard]] double share_in_log(std::string_view log);

}  // namespace aphotic
