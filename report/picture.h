// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that travel inside a page.
#pragma once

#include <string>
#include <string_view>

namespace aphotic {

inline constexpr std::string_view kPng = "image/png";
inline constexpr std::string_view kJpeg = "image/jpeg";

// For src="..."; of a file's bytes.
[[nodiscard]] std::string data_uri(std::string_view picture, std::string_view type = kPng);

// An <img>. A small PNG shows its pixels as squares.
[[nodiscard]] std::string picture_html(std::string_view picture,
                                       int width_px,
                                       int height_px,
                                       std::string_view words,
                                       std::string_view type = kPng);

}  // namespace aphotic
