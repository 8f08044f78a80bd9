// SPDX-License-Identifier: BSD-3-Clause
//
// The kind of a file given instead of text, from its first bytes: "a PNG image", "a zip archive,
// such as .xlsx or .npz". Messages can thus be more specific than "invalid text".
#pragma once

#include <string_view>

namespace aphotic {

// Empty for unknown kinds.
[[nodiscard]] std::string_view binary_kind(std::string_view bytes);

}  // namespace aphotic
