// SPDX-License-Identifier: BSD-3-Clause
#include "cli/terminal.h"

#include "base/error.h"

#include <cstdio>

namespace aphotic::cli {

void say_text(std::string_view text) {
    fmt::print("{}", printable(text, "\n\t"));
}

void warn_text(std::string_view message) {
    fmt::print(stderr, "aphotic: {}\n", whole_message(message));
}

void flush_said() {
    if (std::fflush(stdout) != 0) throw RunError("standard output: cannot be written to");
}

}  // namespace aphotic::cli
