// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help.h"

#include "cli/option_words.h"

#include <fmt/format.h>

namespace aphotic::cli {
namespace {

// A text escaped for roff, in one line.
std::string roff(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else {
            result += c == '\n' ? ' ' : c;
        }
    }
    const bool is_request = result.starts_with('.') || result.starts_with('\'');
    return is_request ? "\\&" + result : result;
}

std::string option_text(const HelpFormatter& help, const CLI::Option& option) {
    const bool is_argument = option.get_positional();
    const std::string name = roff(help.make_option_name(&option, is_argument));
    const std::string value = roff(help.make_option_opts(&option));
    return fmt::format(".TP\n\\f{}{}\\fR{}\n{}\n",
                       is_argument ? 'I' : 'B',
                       name,
                       value.empty() ? "" : fmt::format("\\fI{}\\fR", value),
                       roff(help.make_option_desc(&option)));
}

std::string options_text(const HelpFormatter& help, const CLI::App& command) {
    std::string text;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional()) text += option_text(help, *option);
    for (const std::string& group : command.get_groups()) {
        if (group.empty()) continue;  // hidden
        std::string options;
        for (const CLI::Option* option : command.get_options())
            if (!option->get_positional() && option->get_group() == group)
                options += option_text(help, *option);
        if (!options.empty() && group != "Options") text += fmt::format(".PP\n{}:\n", roff(group));
        text += options;
    }
    return text;
}

std::string text_of_command(const HelpFormatter& help, const CLI::App& command) {
    std::string arguments;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional()) arguments += " " + option->get_name(true);
    std::string text = fmt::format(".SS aphotic {}\n.B aphotic {}\n[options]{}\n.PP\n{}.\n",
                                   command.get_name(),
                                   command.get_name(),
                                   roff(arguments),
                                   roff(command.get_description()));
    const bool has_own_footer = command.get_footer() != command.get_parent()->get_footer();
    if (has_own_footer) text += ".PP\n" + roff(command.get_footer()) + "\n";
    return text + options_text(help, command);
}

}  // namespace

std::string manual_page(const CLI::App& app) {
    const HelpFormatter help;
    std::string text = fmt::format(
        ".TH APHOTIC 1 \"\" \"{}\" \"User Commands\"\n"
        ".SH NAME\n"
        "aphotic \\- spectral images of the sea floor by strobe light, rendered with POV\\-Ray\n"
        ".SH SYNOPSIS\n"
        ".B aphotic\n"
        ".I COMMAND\n"
        "[options] [arguments]\n"
        ".SH DESCRIPTION\n"
        "{}\n"
        ".SH OPTIONS\n"
        "{}"
        ".SH COMMANDS\n",
        roff(app.version()),
        roff(app.get_description()),
        options_text(help, app));
    for (const CLI::App* command : app.get_subcommands({})) text += text_of_command(help, *command);
    return text.append(command_text("manual_end.roff"));
}

}  // namespace aphotic::cli
