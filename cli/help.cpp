// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace aphotic::cli {
namespace {

constexpr std::size_t kColumns = 80;
constexpr std::size_t kNameColumns = 26;

// Wraps lines at blanks, and keeps existing line breaks.
std::string wrapped(const std::string& text, std::size_t columns) {
    std::string result;
    std::istringstream paragraphs(text);
    for (std::string paragraph; std::getline(paragraphs, paragraph);) {
        if (!result.empty()) result += '\n';
        std::size_t used = 0;
        std::istringstream words(paragraph);
        for (std::string word; words >> word; used += word.size()) {
            if (used > 0) {
                const bool fits = used + 1 + word.size() <= columns;
                result += fits ? ' ' : '\n';
                used = fits ? used + 1 : 0;
            }
            result += word;
        }
    }
    return result;
}

// A type's name, such as "INT:1 to 48" or "TEXT:{tiff,png,exr}", consists of the kind and the
// allowed values.
struct OptionType {
    explicit OptionType(const std::string& name)
        : word(name.substr(0, name.find(':'))),
          allowed(name.size() > word.size() ? name.substr(word.size() + 1) : "") {}

    [[nodiscard]] bool is_number() const {
        return word == "FLOAT" || word == "INT" || word == "UINT";
    }

    std::string word;
    std::string allowed;
};

}  // namespace

HelpFormatter::HelpFormatter() {
    column_width(kNameColumns);
    label("Positionals", "Arguments");
    label("SUBCOMMAND", "COMMAND");
}

std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
    return "\n" + Formatter::make_usage(app, std::move(name));
}

std::string HelpFormatter::make_positionals(const CLI::App* app) const {
    return Formatter::make_positionals(app) + "\n";
}

std::string HelpFormatter::make_group(std::string group,
                                      bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
    const std::string text = Formatter::make_group(std::move(group), is_positional, options);
    return is_positional ? text : text.substr(1);  // CLI11 separates groups by two empty lines
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
    return app->get_footer().empty() ? "" : wrapped(app->get_footer(), kColumns) + "\n";
}

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool is_positional) const {
    if (is_positional) return option->get_name(true, false);
    const std::string name = option->get_name(false, false);
    const auto& letters = option->get_snames();
    return letters.empty() ? name : fmt::format("-{}, {}", letters.front(), name);
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    if (option->get_positional() || option->get_type_size() == 0) return "";
    if (!option->get_option_text().empty()) return " " + option->get_option_text();
    const OptionType type(option->get_type_name());
    if (type.is_number()) return " N";
    if (type.word != "TEXT" || type.allowed.empty()) return " " + type.word;
    std::string words = type.allowed;
    std::erase_if(words, [](char c) { return c == '{' || c == '}'; });
    std::ranges::replace(words, ',', '|');
    return " " + words;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    std::string text = option->get_description();
    const OptionType type(option->get_type_name());
    const std::string usual = option->get_default_str();
    std::string notes = type.is_number() ? type.allowed : "";
    if (option->get_required() && option->nonpositional()) notes = "required";
    if (!usual.empty()) notes += (notes.empty() ? "default: " : "; default: ") + usual;
    if (!notes.empty()) text += fmt::format(" [{}]", notes);
    return wrapped(text, kColumns - kNameColumns);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
    return fmt::format("  {:<12}{}\n", command->get_name(), command->get_description());
}

}  // namespace aphotic::cli
