// SPDX-License-Identifier: BSD-3-Clause
//
// Checks beyond those of a command-line parser: numbers out of range and texts that are not
// numbers, words that stand for values, and output files that would replace their input or have
// another format's extension.
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

}  // namespace aphotic::cli
