// SPDX-License-Identifier: BSD-3-Clause
//
// The words of --help are text, not code: cli/options.toml has the names, values and meanings of
// the options of each command, and of the common ones. Code determines what an option sets and
// allows: numbers out of range and texts that are not numbers are refused, words stand for values,
// and output files must not replace their input or have another format's extension.
#pragma once

#include "base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

// A number from least to most; above 0; from 0 up. The last two are finite.
[[nodiscard]] CLI::Validator in_range(double least, double most);
[[nodiscard]] CLI::Validator positive();
[[nodiscard]] CLI::Validator not_negative();

// One of these words, converted to its value.
template <class Value>
[[nodiscard]] CLI::Validator word_of(const std::map<std::string, Value>& words) {
    return {[words](std::string& text) {
                const auto found = words.find(text);
                if (found == words.end()) {
                    std::vector<std::string> allowed;
                    for (const auto& word : words) allowed.push_back(word.first);
                    return fmt::format("found {}; allowed: {}", text, fmt::join(allowed, ", "));
                }
                text = fmt::to_string(static_cast<int>(found->second));
                return std::string();
            },
            ""};
}

// Refuses values for which this throws an InputError.
template <typename Read>
[[nodiscard]] CLI::Validator refused_by(const Read& read) {
    return {[read](const std::string& text) {
                try {
                    static_cast<void>(read(text));
                    return std::string();
                } catch (const InputError& error) {
                    return std::string(error.what());
                }
            },
            ""};
}

// An option whose text `read` converts to a value; an InputError from it refuses the text.
template <typename Value, typename Read>
CLI::Option* add_read(CLI::App& app, const std::string& name, Value& value, const Read& read) {
    const auto take = [&value, read](const std::string& text) { value = read(text); };
    return add_option_function<std::string>(app, name, take)->check(refused_by(read));
}

// For a reader that returns an empty value if the text is invalid.
template <typename Read>
auto read_by(const Read& read, const std::string& allowed) {
    return [read, allowed](const std::string& text) {
        auto value = read(text);
        if (!value) throw InputError("found '{}'; allowed: {}", text, allowed);
        return *value;
    };
}

// Options with a number refuse NaN, which no range does; those with a file or folder refuse the
// empty name; and those that write a file of one format, with a type name such as FILE.exr, refuse
// other extensions.
void add_common_checks(CLI::App& command);

// After parsing: the output files and folders that the options name.
[[nodiscard]] std::vector<std::filesystem::path> written_places(const CLI::App& command);

// After parsing: throws InputError if an output file is also named by another option, or lies in a
// folder that another option names.
void require_separate_files(const CLI::App& command);

}  // namespace cli
}  // namespace aphotic
