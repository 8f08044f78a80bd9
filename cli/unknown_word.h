// SPDX-License-Identifier: BSD-3-Clause
//
// Unknown words of a command line, each with the known one that was probably meant
// (base/nearest.h):
//
//   aphotic: found rendr; no such command: did you mean render?
//   aphotic plan: found --tolerence; no such option: did you mean --tolerance?
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>

namespace aphotic::cli {

// ": did you mean ...?", or how to list all if none is close.
[[nodiscard]] std::string nearest_command(const CLI::App& app, std::string_view wanted);

// After a failed parse: a line for each unknown word. Empty if all are known.
[[nodiscard]] std::string unknown_words(const CLI::App& app);

}  // namespace aphotic::cli
