// SPDX-License-Identifier: BSD-3-Clause
//
// Completion for shells: a script generated from the parser's own tables, so that it offers what
// the command accepts. Of an option's spellings it offers the one in --help, and after any of them
// its words, its files by extension or its folders.
#pragma once

#include <CLI/CLI.hpp>

#include <array>
#include <string>
#include <string_view>

namespace aphotic::cli {

inline constexpr std::array<const char*, 3> kShells{"bash", "zsh", "fish"};

// shell: one of kShells.
[[nodiscard]] std::string completion_script(const CLI::App& app, std::string_view shell);

}  // namespace aphotic::cli
