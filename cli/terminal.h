// SPDX-License-Identifier: BSD-3-Clause
//
// The command's output: results on standard output, messages on standard error. No other code
// prints (scripts/banned), so file names, cells of tables and other programs' output cannot control
// the terminal or imitate our lines: see base/printable.h.
#pragma once

#include "base/printable.h"

#include <fmt/format.h>

#include <string_view>

namespace aphotic::cli {

// A text of several lines, unchanged except for control characters.
void say_text(std::string_view text);

// Like fmt::print(), with strings among the values on one line.
template <typename... Values>
void say(fmt::format_string<Values...> text, const Values&... values) {
    say_text(fmt::format(fmt::runtime(text), shown_value(values)...));
}

// A line on standard error, "aphotic: " and the message, whose own lines it keeps.
void warn_text(std::string_view message);

template <typename... Values>
void warn(fmt::format_string<Values...> text, const Values&... values) {
    warn_text(fmt::format(fmt::runtime(text), shown_value(values)...));
}

// Checks that output was written: a full disk behind a redirection is a RunError.
void flush_said();

}  // namespace aphotic::cli
