// SPDX-License-Identifier: BSD-3-Clause
//
// The words of --help are text, not code: cli/options.toml has the names, values and meanings of
// the options of each command, and of the common ones. Code determines what an option sets and
// allows.
#pragma once

#include <CLI/CLI.hpp>

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace aphotic {

struct CommandText {
    std::string_view name;  // of a file of cli/
    std::string_view text;
};

[[nodiscard]] std::span<const CommandText> command_texts();

namespace cli {

// A file of cli/ embedded in the command: options.toml, and the ends of the manual page and the
// start of bash's completion.
[[nodiscard]] std::string_view command_text(std::string_view file);

// Sets the command's summary, its heading in the list, and its footer.
void describe(CLI::App& command);

// The state left by an interrupted run of it, and how to continue.
[[nodiscard]] std::string what_is_kept(const CLI::App& command);

// All spellings of an option or argument of the command, by the first long one: "--output".
[[nodiscard]] std::string spellings_of(const CLI::App& command, const std::string& name);

// Sets the option's value name, description and default.
CLI::Option* described(const CLI::App& command, const std::string& name, CLI::Option* option);

template <typename Value>
CLI::Option* add_option(CLI::App& app, const std::string& name, Value& value) {
    return described(app, name, app.add_option(spellings_of(app, name), value));
}

// take(text) is called with the value.
template <typename Value, typename Take>
CLI::Option* add_option_function(CLI::App& app, const std::string& name, Take take) {
    CLI::Option* option = app.add_option_function<Value>(spellings_of(app, name), std::move(take));
    return described(app, name, option);
}

// A value to set, or a function to call if the flag is given.
template <typename Value>
CLI::Option* add_flag(CLI::App& app, const std::string& name, Value&& value) {
    const std::string names = spellings_of(app, name);
    if constexpr (std::is_invocable_v<Value>) {
        return described(app, name, app.add_flag_callback(names, std::forward<Value>(value)));
    } else {
        return described(app, name, app.add_flag(names, value));
    }
}

}  // namespace cli
}  // namespace aphotic
