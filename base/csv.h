// SPDX-License-Identifier: BSD-3-Clause
//
// Lines, fields and words of text files written by hand or by programs. Lines end in LF or CR LF.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace aphotic {

inline constexpr std::string_view kBlanks = " \t\r\n\f\v";

[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

[[nodiscard]] inline std::vector<std::string_view> comma_fields(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t start = 0; start <= line.size();) {
        const std::size_t end = std::min(line.find(',', start), line.size());
        fields.push_back(trimmed(line.substr(start, end - start)));
        start = end + 1;
    }
    return fields;
}

[[nodiscard]] inline std::vector<std::string_view> words_in(std::string_view text) {
    std::vector<std::string_view> words;
    while (!(text = trimmed(text)).empty()) {
        words.push_back(text.substr(0, text.find_first_of(kBlanks)));
        text.remove_prefix(words.back().size());
    }
    return words;
}

// Takes the first line off a text that is not empty, and returns it without its LF.
[[nodiscard]] inline std::string_view next_line(std::string_view& text) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    return line;
}

// Removes the byte order mark that spreadsheets put before UTF-8.
[[nodiscard]] inline std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

// Calls visit(line number from 1, line) and returns the number of lines.
template <typename Visit>
std::size_t for_each_line(std::string_view text, const Visit& visit) {
    text = without_byte_order_mark(text);
    std::size_t number = 0;
    while (!text.empty()) visit(++number, next_line(text));
    return number;
}

}  // namespace aphotic
