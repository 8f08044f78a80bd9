// SPDX-License-Identifier: BSD-3-Clause
//
// JSON from a file that anyone may have written. Values nested deeper than kMostJsonDepth are
// refused before they are built, since copying, printing or destroying them is recursive.
//
// An object's keys are sorted, not in the text's order, so that lookup stays fast with a million of
// them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace aphotic {

inline constexpr int kMostJsonDepth = 64;

// An InputError starts with what, the file's name.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& what);

// As written to files: indented, with a final newline. Titles come from the user and may not be
// UTF-8, which JSON requires: invalid bytes are replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

// The library converts 1e99 to any int without complaint, so the number is checked first. Counts
// are limited only to those that a double represents exactly.
inline constexpr std::int64_t kMostWholeNumber = std::int64_t{1}
                                                 << std::numeric_limits<double>::digits;
[[nodiscard]] bool is_whole_number(const nlohmann::json& value,
                                   std::int64_t least,
                                   std::int64_t most);

// The value of an object's key, which must exist. An InputError starts with the key.
[[nodiscard]] std::int64_t whole_number_at(const nlohmann::json& object,
                                           const std::string& key,
                                           std::int64_t least = 0,
                                           std::int64_t most = kMostWholeNumber);

}  // namespace aphotic
