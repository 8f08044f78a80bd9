// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/json_text.h"

#include "spectral/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace aphotic {
namespace {

// The library's own way to look at each value as it begins walks through all values of a list
// whenever one of them ends.
int depth_of(std::string_view text) {
    int depth = 0;
    int deepest = 0;
    bool is_in_text = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '"') is_in_text = !is_in_text;
        if (is_in_text) {
            if (c == '\\') ++at;
        } else if (c == '[' || c == '{') {
            deepest = std::max(deepest, ++depth);
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return deepest;
}

}  // namespace

nlohmann::json parse_json(std::string_view text, const std::string& what) {
    if (const int depth = depth_of(text); depth > kMostJsonDepth) {
        throw InputError(fmt::format("{}: found values nested in {} levels; allowed: up to {}",
                                     what,
                                     depth,
                                     kMostJsonDepth));
    }
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded()) throw InputError(what + ": is not JSON");
    return json;
}

}  // namespace aphotic
