// SPDX-License-Identifier: BSD-3-Clause
#include "rig/key_depth.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace aphotic {
namespace {

std::size_t line_end(std::string_view toml, std::size_t at) {
    return std::min(toml.find('\n', at), toml.size());
}

// In texts of "..." a backslash takes the meaning from what follows; in those of '...' it is one.
std::size_t step_in_text(std::string_view toml, std::size_t at, char quote) {
    return quote == '"' && toml[at] == '\\' ? at + 2 : at + 1;
}

// """...""" may end in up to two quotation marks of its own before the three.
std::size_t end_of_long_text(std::string_view toml, std::size_t at, char quote) {
    constexpr std::size_t kMarks = 3;
    const std::string marks(kMarks, quote);
    while (at < toml.size() && toml.substr(at, kMarks) != marks) {
        at = step_in_text(toml, at, quote);
    }
    const std::size_t most = at + kMarks + 2;
    while (at < std::min(most, toml.size()) && toml[at] == quote) ++at;
    return at;
}

// Where the text that begins here in quotation marks ends. One of a line ends with it, if only in
// an error.
std::size_t end_of_text(std::string_view toml, std::size_t at) {
    const char quote = toml[at];
    if (toml.substr(at, 3) == std::string(3, quote)) {
        return end_of_long_text(toml, at + 3, quote);
    }
    for (++at; at < toml.size() && toml[at] != '\n';) {
        if (toml[at] == quote) return at + 1;
        at = step_in_text(toml, at, quote);
    }
    return at;
}

[[noreturn]] void fail(std::string_view toml, std::size_t at, const std::string& file_name) {
    throw InputError(
        fmt::format("{}:{}: found a key of more than {} parts with dots between them; "
                    "allowed: up to {}",
                    file_name,
                    1 + std::ranges::count(toml.substr(0, at), '\n'),
                    kMostKeyParts,
                    kMostKeyParts));
}

}  // namespace

void require_shallow_keys(std::string_view toml, const std::string& file_name) {
    // What cannot stand inside a key; a value has one dot at most.
    constexpr std::string_view kBetweenKeys = "=[]{},\n";
    std::size_t parts = 1;
    for (std::size_t at = 0; at < toml.size();) {
        const char c = toml[at];
        if (c == '#') {
            at = line_end(toml, at);
        } else if (c == '"' || c == '\'') {
            at = end_of_text(toml, at);
        } else {
            if (c == '.' && ++parts > kMostKeyParts) fail(toml, at, file_name);
            if (kBetweenKeys.find(c) != std::string_view::npos) parts = 1;
            ++at;
        }
    }
}

}  // namespace aphotic
