// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/key_depth.h"

#include "base/error.h"

#include <algorithm>

namespace aphotic {
namespace {

// The end of the quoted string that begins here. Triple quotes end at three, with up to two more
// that belong to the string; any other string ends with its line at the latest, in which case it is
// an error.
std::size_t end_of_text(std::string_view toml, std::size_t at) {
    const char quote = toml[at];
    const std::string long_mark(3, quote);
    const bool is_long = toml.substr(at).starts_with(long_mark);
    const std::string_view mark = std::string_view(long_mark).substr(is_long ? 0 : 2);
    const auto ends = [&] {
        return toml.substr(at).starts_with(mark) || (!is_long && toml[at] == '\n');
    };
    // In "..." a backslash escapes the next character.
    for (at += mark.size(); at < toml.size() && !ends();) {
        at += quote == '"' && toml[at] == '\\' ? 2 : 1;
    }
    return is_long ? toml.find_first_not_of(quote, at) : at + 1;
}

}  // namespace

void require_shallow_keys(std::string_view toml, const std::string& file_name) {
    // Characters that cannot be inside a key; a value has one dot at most.
    constexpr std::string_view kBetweenKeys = "=[]{},\n";
    std::size_t parts = 1;
    for (std::size_t at = 0; at < toml.size();) {
        const char c = toml[at];
        if (c == '"' || c == '\'') {
            at = end_of_text(toml, at);
            continue;
        }
        at = c == '#' ? toml.find('\n', at) : at + 1;
        if (kBetweenKeys.find(c) != std::string_view::npos) parts = 1;
        if (c != '.' || ++parts <= kMostKeyParts) continue;
        throw InputError("{0}:{1}: found a dotted key of more than {2} parts; allowed: up to {2}",
                         file_name,
                         1 + std::ranges::count(toml.substr(0, at), '\n'),
                         kMostKeyParts);
    }
}

}  // namespace aphotic
