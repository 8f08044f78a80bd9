// SPDX-License-Identifier: BSD-3-Clause
//
// The two ways in which a run can fail through no fault of the program.
//
// InputError  the user's input is wrong: option, rig, table, manifest.
//             The message states the place, what was found and what is allowed. Exit status 2.
// RunError    POV-Ray or the file system failed. The message names the file or frame.
//             Exit status 3.
#pragma once

#include "base/printable.h"

#include <fmt/core.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace aphotic {

// Made from a message, or from fmt::format()'s arguments. Names and values in it may come from
// anyone: what() has their control characters escaped and its length is limited (base/printable.h).
class Failure : public std::runtime_error {
  public:
    explicit Failure(std::string_view message) : runtime_error(whole_message(message)) {}
    template <typename First, typename... Rest>
    explicit Failure(fmt::format_string<First, Rest...> text,
                     const First& first,
                     const Rest&... rest)
        : Failure(fmt::format(fmt::runtime(text), shown_value(first), shown_value(rest)...)) {}
};

class InputError : public Failure {
  public:
    using Failure::Failure;
};

class RunError : public Failure {
  public:
    using Failure::Failure;
};

// An InputError about a line of a user's file.
[[noreturn]] inline void fail_at_line(const std::string& file,
                                      std::size_t line,
                                      const std::string& what) {
    throw InputError("{}:{}: {}", file, line, what);
}
template <typename First, typename... Rest>
[[noreturn]] void fail_at_line(const std::string& file,
                               std::size_t line,
                               fmt::format_string<First, Rest...> what,
                               First&& first,
                               Rest&&... rest) {
    fail_at_line(
        file, line, fmt::format(what, std::forward<First>(first), std::forward<Rest>(rest)...));
}

// Does the work and returns its result; an InputError in it is prefixed with `where`, a file or
// folder.
template <typename Work>
auto naming(const std::string& where, const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw InputError("{}: {}", where, error.what());
    }
}

}  // namespace aphotic
