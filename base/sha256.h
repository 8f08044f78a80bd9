// SPDX-License-Identifier: BSD-3-Clause
//
// SHA-256 (FIPS 180-4) in lower-case hexadecimal, which identifies frames, scenes and rigs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace aphotic {

[[nodiscard]] std::string sha256_of_text(std::string_view text);

// The digest of the samples' bytes in memory.
[[nodiscard]] std::string sha256_of_floats(std::span<const float> samples);

// Throws RunError if the file cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace aphotic
