// SPDX-License-Identifier: BSD-3-Clause
//
// What tests ask of a page's text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

inline bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

// What is left of a page when its tags and pictures are taken away.
inline std::string words_of(const std::string& page) {
    std::string words;
    bool in_tag = false;
    for (const char c : page) {
        if (c == '<') in_tag = true;
        if (!in_tag) words += c;
        if (c == '>') in_tag = false;
    }
    return words;
}

// The name of the first element that is not closed as XML wants it, or nothing.
inline std::string first_unbalanced(const std::string& page) {
    std::vector<std::string> open;
    for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
        const std::size_t end = page.find('>', at);
        if (end == std::string::npos) return "an open tag at the end";
        if (page[at + 1] == '!' || page[end - 1] == '/') continue;
        const bool closes = page[at + 1] == '/';
        const std::size_t from = at + (closes ? 2 : 1);
        std::string name = page.substr(from, page.find_first_of(" >\n", from) - from);
        if (!closes) {
            open.push_back(name);
        } else if (open.empty() || open.back() != name) {
            return name;
        } else {
            open.pop_back();
        }
    }
    return open.empty() ? "" : open.back();
}

}  // namespace aphotic
