// SPDX-License-Identifier: BSD-3-Clause
//
// How deep the keys of a TOML text nest their tables: a.b.c = 1 and [a.b.c] have three parts. The
// library that reads TOML limits the nesting of values, not of keys, and takes a call for each
// level to destroy the tables: of fifty thousand parts, in a hundred kB, it runs out of stack.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace aphotic {

// A rig's own have up to three, such as camera.response.table.
inline constexpr std::size_t kMostKeyParts = 16;

// Throws InputError, with the line, where a key has more parts than that. Dots in texts and
// comments do not count; whatever else is wrong with the text is the library's to say.
void require_shallow_keys(std::string_view toml, const std::string& file_name);

}  // namespace aphotic
