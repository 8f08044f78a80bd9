// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures embedded in a page.
#pragma once

#include <string>
#include <string_view>

namespace aphotic {

inline constexpr std::string_view kPng = "image/png";
inline constexpr std::string_view kJpeg = "image/jpeg";

// The value of src="...", from a file's bytes.
[[nodiscard]] std::string data_uri(std::string_view picture, std::string_view type = kPng);

}  // namespace aphotic
