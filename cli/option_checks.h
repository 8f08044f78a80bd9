// SPDX-License-Identifier: BSD-3-Clause
//
// What a parser of command lines does not see: numbers that are none, and files that would be
// written in the place of what they are made from.
#pragma once

#include <CLI/CLI.hpp>

namespace aphotic::cli {

// Every option of the command that takes a number refuses NaN, which no range does.
void refuse_nan(CLI::App& command);

// Once parsed: throws InputError when a file to be written is one that another option names, or
// one that stands in a folder that another option names.
void require_separate_files(const CLI::App& command);

}  // namespace aphotic::cli
