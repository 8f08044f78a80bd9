// SPDX-License-Identifier: BSD-3-Clause
//
// Reads a rig file (TOML) into a Rig in SI. The schema is in docs/reference/rig.md.
//
// Every value is checked for type, unit, range and finiteness; every key must be known. An
// error is an InputError of the form
//
//   rig.toml:7: camera.focal_length_mm: found -12; allowed: a number from 0.01 to 100000
//
// and an unknown key names the nearest known one.
#pragma once

#include "rig/rig.h"

#include <filesystem>
#include <string_view>

namespace aphotic {

inline constexpr double kLeastScale = 0.001;  // of camera.scale

// User tables named in the file are read from its folder.
[[nodiscard]] Rig read_rig(const std::filesystem::path& file);

// The same from text; file_name is for messages, tables are read from folder.
[[nodiscard]] Rig parse_rig(std::string_view toml,
                            const std::string& file_name,
                            const std::filesystem::path& folder);

}  // namespace aphotic
