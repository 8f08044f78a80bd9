// SPDX-License-Identifier: BSD-3-Clause
//
// The text of a scene of the project's, and changes to a text, each of which must find its place.
#pragma once

#include "base/atomic_file.h"
#include "support/has.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

// "habcam.toml", below scenes/.
inline std::filesystem::path scene_file(const std::filesystem::path& name) {
    return std::filesystem::path(APHOTIC_SOURCE_DIR) / "scenes" / name;
}
inline std::string scene_text(const std::filesystem::path& name) {
    return read_text_file(scene_file(name));
}

// Wherever it stands.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    EXPECT_TRUE(has(text, from)) << "nothing to replace: " << from;
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

// A rig's text with other values: {{"resolution", "[16, 12]"}}.
inline std::string with(std::string text,
                        const std::vector<std::pair<std::string, std::string>>& values) {
    for (const auto& [key, value] : values) {
        const std::regex line("\n\\s*" + key + "\\s*=[^\n]*");
        EXPECT_TRUE(std::regex_search(text, line)) << "no line of " << key;
        text = std::regex_replace(text, line, "\n" + key + " = " + value);
    }
    return text;
}

}  // namespace aphotic
