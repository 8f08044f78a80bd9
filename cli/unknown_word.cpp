// SPDX-License-Identifier: BSD-3-Clause
#include "cli/unknown_word.h"

#include "base/nearest.h"
#include "base/printable.h"

#include <fmt/format.h>

#include <vector>

namespace aphotic::cli {
namespace {

std::string nearest_option(const CLI::App& command, std::string_view wanted) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options()) {
        const auto& names = option->get_lnames();
        known.insert(known.end(), names.begin(), names.end());
    }
    const std::string nearest = nearest_name(wanted.substr(2), known);
    return nearest.empty() ? "; --help lists them" : fmt::format(": did you mean --{}?", nearest);
}

// A line for a word that is an option; empty for others.
std::string unknown_option(const CLI::App& command,
                           const std::string& name,
                           const std::string& word) {
    if (!word.starts_with("--")) return "";
    const std::string option = word.substr(0, word.find('='));
    return fmt::format(
        "{}: found {}; no such option{}\n", name, excerpt(option), nearest_option(command, option));
}

}  // namespace

std::string nearest_command(const CLI::App& app, std::string_view wanted) {
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
    const std::string nearest = nearest_name(wanted, known);
    return nearest.empty() ? "; --help lists them" : fmt::format(": did you mean {}?", nearest);
}

std::string unknown_words(const CLI::App& app) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    std::string lines;
    for (const std::string& word : app.remaining()) {
        if (chosen.empty() && !word.starts_with("-")) {
            // The words after it belong to it.
            return lines + fmt::format("{}: found {}; no such command{}\n",
                                       app.get_name(),
                                       excerpt(word),
                                       nearest_command(app, word));
        }
        lines += unknown_option(app, app.get_name(), word);
    }
    for (const CLI::App* command : chosen) {
        const std::string name = app.get_name() + " " + command->get_name();
        for (const std::string& word : command->remaining())
            lines += unknown_option(*command, name, word);
    }
    return lines;
}

}  // namespace aphotic::cli
