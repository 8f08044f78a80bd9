// SPDX-License-Identifier: BSD-3-Clause
//
// JSON from a file that anybody may have written. What is nested deeper than kMostJsonDepth is
// refused before it is built: to copy, print or destroy such a value takes a call for each level.
//
// The keys of an object come in their own order, not the text's: to look one up takes no longer
// where there are a million.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace aphotic {

inline constexpr int kMostJsonDepth = 64;

// An InputError begins with what, the name of the file.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& what);

// As it is written into files: indented, the last line ended. Titles are the user's and need not be
// UTF-8; JSON must be: what is none is replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

// The library turns 1e99 into any int: a number is asked first. Counts have no bound but that every
// double up to it is a whole number.
inline constexpr std::int64_t kMostWholeNumber = std::int64_t{1}
                                                 << std::numeric_limits<double>::digits;
[[nodiscard]] bool is_whole_number(const nlohmann::json& value,
                                   std::int64_t least,
                                   std::int64_t most);

// That of an object's key, which must be there. An InputError begins with the key.
[[nodiscard]] std::int64_t whole_number_at(const nlohmann::json& object,
                                           const std::string& key,
                                           std::int64_t least = 0,
                                           std::int64_t most = kMostWholeNumber);

}  // namespace aphotic
