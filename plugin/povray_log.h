// SPDX-License-Identifier: BSD-3-Clause
//
// What POV-Ray prints: its messages are wrapped at 80 columns, what goes on is indented with one
// blank, and progress overwrites itself.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// A log as it was written, up to the size at which POV-Ray is stopped (plugin/process.h).
[[nodiscard]] std::string read_log(const std::filesystem::path& log);

// Its messages, one an entry, unwrapped.
[[nodiscard]] std::vector<std::string> statements_in_log(const std::string& log);

// What it says went wrong: the error with its file and line. The first few errors, when there are
// more than one reads.
[[nodiscard]] std::string error_in_log(const std::string& log);

// The last share of the pixels, from 0 to 1, that it says are rendered: "(27%)". 0 when it says
// none, or one that cannot be.
[[nodiscard]] double share_in_log(std::string_view log);

}  // namespace aphotic
