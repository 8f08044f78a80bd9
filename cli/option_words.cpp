// SPDX-License-Identifier: BSD-3-Clause
#include "cli/option_words.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <stdexcept>

namespace aphotic::cli {
namespace {

const toml::table& all_words() {
    static const toml::table kWords = toml::parse(command_text("options.toml"));
    return kWords;
}

// The command's own words, else the common ones.
const toml::table& words_of(const CLI::App& command, const std::string& name) {
    for (const std::string& place : {command.get_name(), std::string("shared")}) {
        const toml::node* of_place = all_words().get(place);
        const toml::node* words = of_place != nullptr ? of_place->as_table()->get(name) : nullptr;
        if (words != nullptr) return *words->as_table();
    }
    throw std::logic_error(fmt::format("{} {}: not in options.toml", command.get_name(), name));
}

}  // namespace

std::string_view command_text(std::string_view file) {
    return std::ranges::find(command_texts(), file, &CommandText::name)->text;
}

void describe(CLI::App& command) {
    const toml::table& words = *all_words().get(command.get_name())->as_table();
    command.description(words["summary"].value_or(std::string()));
    command.group(words["under"].value_or(std::string()));
    if (const auto footer = words["footer"].value<std::string>()) command.footer(*footer);
}

std::string what_is_kept(const CLI::App& command) {
    const auto keeps = all_words()[command.get_name()]["keeps"].value<std::string>();
    return keeps ? *keeps + " are kept: run the same command again to continue"
                 : "run the same command again to start afresh";
}

std::string spellings_of(const CLI::App& command, const std::string& name) {
    return words_of(command, name)["names"].value_or(name);
}

CLI::Option* described(const CLI::App& command, const std::string& name, CLI::Option* option) {
    const toml::table& words = words_of(command, name);
    option->description(words["words"].value_or(std::string()));
    if (const auto takes = words["takes"].value<std::string>()) option->option_text(*takes);
    if (const auto type = words["type"].value<std::string>()) option->type_name(*type);
    if (const auto usual = words["usual"].value<std::string>()) option->default_str(*usual);
    if (words["usual"].value_or(false)) option->capture_default_str();
    return option;
}

}  // namespace aphotic::cli
