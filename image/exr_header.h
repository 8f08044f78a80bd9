// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the header of an OpenEXR file is as long as the file: looked at before OpenEXR reads it,
// which takes a size there at its word and asks for gigabytes on a damaged one.
//
//   magic, version                      4 bytes each, little-endian as all numbers
//   name \0 type \0 size value ...      attributes, size is 4 bytes, the value as many as it says
//   \0                                  ends a header; files of several parts end with two
#pragma once

#include <filesystem>

namespace aphotic {

// Throws std::runtime_error that says what is wrong.
void require_sound_exr_header(const std::filesystem::path& file);

}  // namespace aphotic
