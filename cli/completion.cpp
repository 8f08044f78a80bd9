// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help.h"

#include "cli/option_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <sstream>
#include <vector>

namespace aphotic::cli {
namespace {

// The kind of value that an option or argument takes.
struct Taken {
    enum class Kind { Nothing, Text, Words, File, Folder };
    Kind kind = Kind::Text;
    std::vector<std::string> words{};
    std::string extension{};  // of files; empty: any
    bool is_many = false;
};

struct Offer {
    std::string letter{};  // empty if there is none
    std::string name;
    std::vector<std::string> spellings;  // including dashes
    std::string words;
    Taken taken;
};

struct Offers {
    std::string command;  // empty: before any command
    std::string words;
    std::vector<Offer> options{};
    std::vector<Taken> arguments{};
};

std::vector<std::string> split(const std::string& text, char mark) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, mark);) parts.push_back(part);
    return parts;
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

bool contains(std::initializer_list<std::string_view> words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

// From the type's name: TEXT:{a,b} or a|b are words, FILE.svg and RIG are files.
Taken taken_by(const CLI::App& app, const CLI::Option& option) {
    Taken taken{.is_many = option.get_items_expected_max() > 1};
    const std::string type = option.get_positional() && option.get_type_name() == "TEXT"
                                 ? option.get_name(true)
                                 : option.get_type_name();
    const std::size_t open = type.find('{');
    const bool is_word_or_file = type.ends_with("|FILE");  // the rig's names are not known here
    if (type == "COMMAND") {
        taken.kind = Taken::Kind::Words;
        taken.words = command_names(*app.get_parent());
    } else if (option.get_items_expected_max() == 0) {
        taken.kind = Taken::Kind::Nothing;
    } else if (open != std::string::npos) {
        taken.kind = Taken::Kind::Words;
        taken.words = split(type.substr(open + 1, type.find('}') - open - 1), ',');
    } else if (type.find('|') != std::string::npos && !is_word_or_file) {
        taken.kind = Taken::Kind::Words;
        taken.words = split(type, '|');
    } else if (type == "DIR") {
        taken.kind = Taken::Kind::Folder;
    } else if (type == "RIG") {
        taken.kind = Taken::Kind::File;
        taken.extension = "toml";
    } else if (type.starts_with("FILE.") || type.starts_with("MAP.")) {
        taken.kind = Taken::Kind::File;
        taken.extension = type.substr(type.find('.') + 1);
    } else if (is_word_or_file ||
               contains({"FILE", "IMAGE", "IMAGES", "PROGRAM", "NAME", "A", "B"}, type)) {
        taken.kind = Taken::Kind::File;
    }
    return taken;
}

Offer offer_of(const CLI::App& app, const CLI::Option& option) {
    Offer offer{.name = option.get_lnames().front(),
                .spellings = {},
                .words = option.get_description(),
                .taken = taken_by(app, option)};
    for (const std::string& name : option.get_lnames()) offer.spellings.push_back("--" + name);
    for (const std::string& name : option.get_snames()) offer.spellings.push_back("-" + name);
    if (!option.get_snames().empty()) offer.letter = option.get_snames().front();
    return offer;
}

Offers offers_of(const CLI::App& app) {
    Offers offers{.command = app.get_parent() ? app.get_name() : "",
                  .words = app.get_description()};
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) {
            offers.arguments.push_back(taken_by(app, *option));
        } else {
            offers.options.push_back(offer_of(app, *option));
        }
    }
    return offers;
}

// The parser's own options first, then its commands'.
std::vector<Offers> all_offers(const CLI::App& app) {
    std::vector<Offers> all{offers_of(app)};
    for (const CLI::App* command : app.get_subcommands({})) all.push_back(offers_of(*command));
    return all;
}

std::string escaped(std::string_view text, std::string_view marks) {
    std::string result;
    for (const char c : text) {
        if (marks.find(c) != std::string_view::npos) result += '\\';
        result += c;
    }
    return result;
}

// A shell's syntax for the possible values.
struct ShellActions {
    std::string_view words;      // with a placeholder
    std::string_view files;      // of any kind
    std::string_view extension;  // files of an extension, with a placeholder
    std::string_view folders;
    std::string_view text;
};

constexpr ShellActions kBash{
    "_aphotic_words '{}'", "_aphotic_files", "_aphotic_files {}", "_aphotic_folders", ":"};
constexpr ShellActions kZsh{"({})", "_files", "_files -g \"*.{}\"", "_files -/", " "};
constexpr ShellActions kFish{" -xa '{}'",
                             " -rF",
                             " -rka '(__fish_complete_suffix .{})'",
                             " -xa '(__fish_complete_directories)'",
                             " -x"};

std::string action_of(const Taken& taken, const ShellActions& shell) {
    switch (taken.kind) {
        case Taken::Kind::Words:
            return fmt::format(fmt::runtime(shell.words), fmt::join(taken.words, " "));
        case Taken::Kind::File:
            return fmt::format(
                fmt::runtime(taken.extension.empty() ? shell.files : shell.extension),
                taken.extension);
        case Taken::Kind::Folder:
            return std::string(shell.folders);
        case Taken::Kind::Text:
            return std::string(shell.text);
        case Taken::Kind::Nothing:
            break;
    }
    return "";
}

// --- bash ---------------------------------------------------------------------------------------

std::string bash_values(const Offers& offers) {
    std::string text;
    for (const Offer& option : offers.options) {
        if (option.taken.kind == Taken::Kind::Nothing) continue;
        std::vector<std::string> patterns;
        for (const std::string& name : option.spellings)
            patterns.push_back(offers.command + "," + name);
        text += fmt::format("        {}) {}; return ;;\n",
                            fmt::join(patterns, " | "),
                            action_of(option.taken, kBash));
    }
    return text;
}

std::string bash_case(const Offers& offers) {
    std::vector<std::string> names;
    for (const Offer& option : offers.options) {
        names.push_back("--" + option.name);
        if (!option.letter.empty()) names.push_back("-" + option.letter);
    }
    std::string text = fmt::format(
        "        {},-*) _aphotic_words '{}' ;;\n", offers.command, fmt::join(names, " "));
    if (offers.arguments.empty()) return text;
    text += fmt::format("        {},*)", offers.command);
    for (const Taken& taken : offers.arguments) text += " " + action_of(taken, kBash) + ";";
    return text + " ;;\n";
}

std::string bash_script(const std::vector<Offers>& all) {
    std::vector<std::string> commands;
    for (const Offers& offers : all) {
        if (!offers.command.empty()) commands.push_back(offers.command);
    }
    std::string text(command_text("completion_head.txt"));
    text += fmt::format("            {}) command=$word; break ;;\n        esac\n    done\n",
                        fmt::join(commands, " | "));
    text += "    case $command,$prev in\n";
    for (const Offers& offers : all) text += bash_values(offers);
    text += "    esac\n    case $command,$cur in\n";
    for (const Offers& offers : all) text += bash_case(offers);
    text += fmt::format("        ,*) _aphotic_words '{}' ;;\n", fmt::join(commands, " "));
    return text + "    esac\n}\ncomplete -F _aphotic aphotic\n";
}

// --- zsh ----------------------------------------------------------------------------------------

std::string quoted_for_zsh(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
    return "'" + result + "'";
}

std::string zsh_words(const std::string& text) {
    return escaped(text, "[]:\\");
}

std::string zsh_options(const Offers& offers) {
    std::string text;
    for (const Offer& option : offers.options) {
        const bool takes = option.taken.kind != Taken::Kind::Nothing;
        const std::string before =
            option.taken.is_many ? "*" : fmt::format("({})", fmt::join(option.spellings, " "));
        const std::string after =
            fmt::format("[{}]{}",
                        zsh_words(option.words),
                        takes ? ":value:" + action_of(option.taken, kZsh) : "");
        std::vector<std::string> names{"--" + option.name + (takes ? "=" : "")};
        if (!option.letter.empty()) names.push_back("-" + option.letter);
        for (const std::string& name : names)
            text += fmt::format(" \\\n            {}", quoted_for_zsh(before + name + after));
    }
    return text;
}

std::string zsh_arguments(const Offers& offers) {
    std::string text;
    for (const Taken& taken : offers.arguments) {
        text += fmt::format(
            " \\\n            '{}:argument:{}'", taken.is_many ? "*" : "", action_of(taken, kZsh));
    }
    return text;
}

std::string zsh_script(const std::vector<Offers>& all) {
    std::string text =
        "#compdef aphotic\n"
        "# zsh completion for aphotic, by: aphotic --completion zsh\n\n"
        "_aphotic() {\n"
        "    local context state state_descr line ret=1\n"
        "    local -a commands\n"
        "    typeset -A opt_args\n"
        "    commands=(\n";
    for (const Offers& offers : all) {
        if (offers.command.empty()) continue;
        text += fmt::format("        {}\n",
                            quoted_for_zsh(offers.command + ":" + escaped(offers.words, ":\\")));
    }
    text += "    )\n    _arguments -C" + zsh_options(all.front()) +
            " \\\n            '1:command:->command' '*::argument:->arguments' && ret=0\n"
            "    case $state in\n"
            "    command) _describe -t commands command commands && ret=0 ;;\n"
            "    arguments)\n"
            "        case $words[1] in\n";
    for (const Offers& offers : all) {
        if (offers.command.empty()) continue;
        text += fmt::format("        {})\n            _arguments -s{}{} && ret=0 ;;\n",
                            offers.command,
                            zsh_options(offers),
                            zsh_arguments(offers));
    }
    return text + "        esac ;;\n    esac\n    return ret\n}\n\n_aphotic \"$@\"\n";
}

// --- fish ---------------------------------------------------------------------------------------

std::string quoted_for_fish(const std::string& text) {
    return "'" + escaped(text, "'\\") + "'";
}

std::string fish_lines(const Offers& offers) {
    const std::string before =
        offers.command.empty()
            ? "complete -c aphotic -n __fish_use_subcommand"
            : fmt::format("complete -c aphotic -n '__fish_seen_subcommand_from {}'",
                          offers.command);
    std::string text;
    if (!offers.command.empty()) {
        text += fmt::format("complete -c aphotic -n __fish_use_subcommand -a {} -d {}\n",
                            offers.command,
                            quoted_for_fish(offers.words));
    }
    for (const Offer& option : offers.options) {
        text += fmt::format("{}{} -l {}{} -d {}\n",
                            before,
                            option.letter.empty() ? "" : " -s " + option.letter,
                            option.name,
                            action_of(option.taken, kFish),
                            quoted_for_fish(option.words));
    }
    for (const Taken& taken : offers.arguments) {
        if (taken.kind != Taken::Kind::Text) text += before + action_of(taken, kFish) + "\n";
    }
    return text;
}

std::string fish_script(const std::vector<Offers>& all) {
    std::string text =
        "# fish completion for aphotic, by: aphotic --completion fish\n\n"
        "complete -c aphotic -f\n";
    for (const Offers& offers : all) text += fish_lines(offers);
    return text;
}

}  // namespace

std::string completion_script(const CLI::App& app, std::string_view shell) {
    const std::vector<Offers> all = all_offers(app);
    if (shell == "zsh") return zsh_script(all);
    if (shell == "fish") return fish_script(all);
    return bash_script(all);
}

}  // namespace aphotic::cli
