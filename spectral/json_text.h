// SPDX-License-Identifier: BSD-3-Clause
//
// JSON from a file that anybody may have written. What is nested deeper than kMostJsonDepth is
// refused before it is built: to copy, print or destroy such a value takes a call for each level.
//
// The keys of an object come in their own order, not the text's: to look one up takes no longer
// where there are a million.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace aphotic {

inline constexpr int kMostJsonDepth = 64;

// An InputError begins with what, the name of the file.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& what);

}  // namespace aphotic
