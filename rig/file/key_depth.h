// SPDX-License-Identifier: BSD-3-Clause
//
// The depth to which keys of a TOML text nest tables: a.b.c = 1 and [a.b.c] have three parts. The
// TOML library limits the nesting of values, not of keys, and destroys tables recursively: fifty
// thousand parts, in a hundred kB, overflow the stack.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace aphotic {

// A rig's own keys have up to three, such as camera.response.table.
inline constexpr std::size_t kMostKeyParts = 16;

// Throws InputError, with the line, if a key has more parts. Dots in strings and comments do not
// count; the library reports anything else that is wrong with the text.
void require_shallow_keys(std::string_view toml, const std::string& file_name);

}  // namespace aphotic
