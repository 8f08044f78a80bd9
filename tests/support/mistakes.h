// SPDX-License-Identifier: BSD-3-Clause
//
// Mistakes in an input, and what is said of each, from a text below tests/:
//
//   # words     are for the reader, like empty lines
//   KEY text    a part of the mistake; the head of the file says what each KEY does
//   | text      goes on below it
//   = words     ends the mistake: the message
#pragma once

#include "base/atomic_file.h"

#include <filesystem>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

struct Mistake {
    struct Part {
        std::string key;
        std::string text;
    };

    std::string file;  // below tests/
    int line = 0;      // of the file
    std::vector<Part> parts;
    std::string message;
};

inline void PrintTo(const Mistake& mistake, std::ostream* out) {
    *out << "tests/" << mistake.file << ":" << mistake.line;
}

// Throws if there are more or fewer, so that none is lost unnoticed.
inline std::vector<Mistake> mistakes_in(const std::string& file, std::size_t count) {
    std::istringstream lines(
        read_text_file(std::filesystem::path(APHOTIC_SOURCE_DIR) / "tests" / file));
    std::vector<Mistake> mistakes;
    Mistake next{.file = file, .line = 0, .parts = {}, .message = {}};
    int line = 0;
    for (std::string text; std::getline(lines, text);) {
        ++line;
        if (text.empty() || text.front() == '#') continue;
        const std::size_t space = text.find(' ');
        const std::string key = text.substr(0, space);
        const std::string rest = space == std::string::npos ? "" : text.substr(space + 1);
        if (key == "=") {
            mistakes.push_back({file, line, std::exchange(next.parts, {}), rest});
        } else if (key == "|") {
            next.parts.back().text += "\n" + rest;
        } else {
            next.parts.push_back({key, rest});
        }
    }
    if (mistakes.size() != count)
        throw std::runtime_error(file + " has " + std::to_string(mistakes.size()) + " mistakes");
    return mistakes;
}

}  // namespace aphotic
