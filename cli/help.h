// SPDX-License-Identifier: BSD-3-Clause
//
// The format of --help: an option, its value and its effect, in 80 columns. From the same tables
// of the parser, the manual page of all commands and the scripts for shells are generated, so that
// they say and offer what the command accepts.
//
//   --tolerance E           Largest relative error of any pixel's signal [0 to 1; default: 0.001]
//
// An option's first long name is shown; the others are old spellings that still work.
#pragma once

#include <CLI/CLI.hpp>

#include <array>
#include <string>
#include <string_view>

namespace aphotic::cli {

class HelpFormatter : public CLI::Formatter {
  public:
    HelpFormatter();

    [[nodiscard]] std::string make_usage(const CLI::App* app, std::string name) const override;
    [[nodiscard]] std::string make_positionals(const CLI::App* app) const override;
    [[nodiscard]] std::string make_group(std::string group,
                                         bool is_positional,
                                         std::vector<const CLI::Option*> options) const override;
    [[nodiscard]] std::string make_footer(const CLI::App* app) const override;
    [[nodiscard]] std::string make_option_name(const CLI::Option* option,
                                               bool is_positional) const override;
    [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;
    [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override;
    [[nodiscard]] std::string make_subcommand(const CLI::App* command) const override;
};

// Each command with its arguments, options, defaults and limits, in roff, for man(1).
[[nodiscard]] std::string manual_page(const CLI::App& app);

inline constexpr std::array<const char*, 3> kShells{"bash", "zsh", "fish"};

// Of an option's spellings it offers the one in --help, and after any of them its words, its files
// by extension or its folders. shell: one of kShells.
[[nodiscard]] std::string completion_script(const CLI::App& app, std::string_view shell);

}  // namespace aphotic::cli
