// SPDX-License-Identifier: BSD-3-Clause
//
// Text from outside, made safe for a message: a control character, which could break the line or
// control a terminal, is shown as \x1b. Other bytes, UTF-8 or not, stay as they are. The length of
// a message is limited, whatever the length of the quoted text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

namespace aphotic {

// keep: control characters that may stay.
[[nodiscard]] std::string printable(std::string_view text, std::string_view keep = {});

// U+0000 to U+001F, U+007F to U+009F.
[[nodiscard]] bool has_control_characters(std::string_view text);

// A value quoted in a message, such as a table's cell: its first bytes, and "..." if there are
// more.
inline constexpr std::size_t kMostQuoted_bytes = 100;
[[nodiscard]] std::string excerpt(std::string_view text);

// A whole message: printable, except its own newlines and tabs. The middle of a long one is
// omitted, since the file's name comes first and the cause last.
inline constexpr std::size_t kMostMessage_bytes = 4000;
[[nodiscard]] std::string whole_message(std::string_view text);

// A text used in a message: printable, newlines included, and no longer than a path with words
// around it.
inline constexpr std::size_t kMostText_bytes = 1500;
[[nodiscard]] std::string shown_text(std::string_view text);

// An argument of a message. A std::string or a view may come from outside. Numbers, our own words
// and const char*, including other failures' messages, stay as they are.
template <typename Value>
[[nodiscard]] decltype(auto) shown_value(const Value& value) {
    if constexpr (std::is_same_v<Value, std::string> || std::is_same_v<Value, std::string_view>) {
        return shown_text(value);
    } else {
        return (value);
    }
}

}  // namespace aphotic
