// SPDX-License-Identifier: BSD-3-Clause
//
// The two ways in which a run can fail through no fault of the program.
//
// InputError  something that the user gave is wrong: option, rig, table, manifest.
//             The message says where, what was found and what is allowed. Exit status 2.
// RunError    POV-Ray or the file system failed. The message says which file or frame.
//             Exit status 3.
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace aphotic {

// Made of a message, or of what fmt::format() makes one of.
class Failure : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
    template <typename First, typename... Rest>
    explicit Failure(fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest)
        : runtime_error(
              fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...)) {}
};

class InputError : public Failure {
  public:
    using Failure::Failure;
};

class RunError : public Failure {
  public:
    using Failure::Failure;
};

// An InputError about a line of a file that the user gave.
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

// The work's result; what it finds wrong with its input is said of `where`: a file or folder.
template <typename Work>
auto naming(const std::string& where, const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw InputError("{}: {}", where, error.what());
    }
}

}  // namespace aphotic
