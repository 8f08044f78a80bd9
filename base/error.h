// SPDX-License-Identifier: BSD-3-Clause
//
// The two ways in which a run can fail through no fault of the program.
//
// InputError  something that the user gave is wrong: option, rig, table, manifest.
//             The message says where, what was found and what is allowed. Exit status 2.
// RunError    POV-Ray or the file system failed. The message says which file or frame.
//             Exit status 3.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace aphotic {

class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

class RunError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// An InputError about a line of a file that the user gave.
[[noreturn]] inline void fail_at_line(const std::string& file,
                                      std::size_t line,
                                      const std::string& what) {
    throw InputError(file + ":" + std::to_string(line) + ": " + what);
}

}  // namespace aphotic
