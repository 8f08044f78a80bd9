// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic help [COMMAND]: prints the --help of the command.
#include "base/error.h"
#include "cli/command.h"
#include "cli/option_words.h"
#include "cli/terminal.h"
#include "cli/unknown_word.h"

#include <memory>
#include <string>

namespace aphotic::cli {
namespace {

ExitStatus print_help(const CLI::App& all, const std::string& name) {
    if (name.empty()) {
        say_text(all.get_formatter()->make_help(&all, all.get_name(), CLI::AppFormatMode::Normal));
        return kDone;
    }
    for (const CLI::App* command : all.get_subcommands({})) {
        if (command->get_name() != name) continue;
        say_text(command->help(all.get_name()));
        return kDone;
    }
    throw InputError("help: found {}; no such command{}", name, nearest_command(all, name));
}

}  // namespace

Action configure_help(CLI::App& app) {
    const auto name = std::make_shared<std::string>();
    add_option(app, "COMMAND", *name);
    return [&app, name] { return print_help(*app.get_parent(), *name); };
}

}  // namespace aphotic::cli
