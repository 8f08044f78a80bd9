// SPDX-License-Identifier: BSD-3-Clause
//
// Words for the command's output: "1 frame", "2 frames"; the word of a value in a table; a path
// quoted for a shell; ASCII in lower case.
#pragma once

#include "base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace aphotic {

[[nodiscard]] inline std::string counted(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// The value is in the table.
template <typename Value>
[[nodiscard]] const std::string& name_of(const std::map<std::string, Value>& words, Value value) {
    return std::ranges::find(words, value, [](const auto& word) { return word.second; })->first;
}

// The output of printf for an ASCII format: a newline in a path reaches the shell as one, and
// does not control a terminal that shows the command. The shell drops a newline at the end.
[[nodiscard]] inline std::string printed_word(std::string_view word) {
    std::string format;
    for (const char c : word) {
        if (c == '\'') {
            format += "'\\''";
        } else if (c == '%' || c == '\\') {
            format += {c, c};
        } else if (c >= ' ' && c <= '~') {
            format += c;
        } else {
            format += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
        }
    }
    return "\"$(printf '" + format + "')\"";
}

// A path quoted so that a user may paste the line into a shell.
[[nodiscard]] inline std::string shell_word(std::string_view path) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+=:,@%";
    std::string word(path.starts_with('-') ? "./" : "");  // not an option
    word += path;
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    if (has_control_characters(word)) return printed_word(word);
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

[[nodiscard]] inline std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

}  // namespace aphotic
