// SPDX-License-Identifier: BSD-3-Clause
//
// The manual page, generated like completion from the parser's own tables: each command with its
// arguments, options, defaults and limits, in roff, for man(1).
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace aphotic::cli {

[[nodiscard]] std::string manual_page(const CLI::App& app);

}  // namespace aphotic::cli
