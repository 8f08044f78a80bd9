// SPDX-License-Identifier: BSD-3-Clause
//
// What a parser of command lines does not see: numbers out of their range or that are none, words
// that stand for something else, and files that would be written in the place of what they are made
// from or under the name of another format.
#pragma once

#include "base/error.h"
#include "cli/option_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace aphotic::cli {

// A number from least to most; above 0; from 0 up. The last two are finite.
[[nodiscard]] CLI::Validator in_range(double least, double most);
[[nodiscard]] CLI::Validator positive();
[[nodiscard]] CLI::Validator not_negative();

// One of these words, for its value.
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

// For a reader that returns nothing if the text is invalid.
template <typename Read>
auto read_by(const Read& read, const std::string& allowed) {
    return [read, allowed](const std::string& text) {
        auto value = read(text);
        if (!value) throw InputError("found '{}'; allowed: {}", text, allowed);
        return *value;
    };
}

// Every option of the command that takes a number refuses NaN, which no range does; one that names
// a file or folder refuses the empty name; and one that writes a file of one format, whose type
// name is such as FILE.exr, refuses other extensions.
void add_common_checks(CLI::App& command);

// After parsing: the files and folders that the options name for output.
[[nodiscard]] std::vector<std::filesystem::path> written_places(const CLI::App& command);

// After parsing: throws InputError if an output file is also named by another option, or lies in a
// folder that another option names.
void require_separate_files(const CLI::App& command);

}  // namespace aphotic::cli
