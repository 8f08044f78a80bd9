// SPDX-License-Identifier: BSD-3-Clause
//
// Checks, by its own directory, that a TIFF file contains all its pixels: libtiff reads the missing
// rows of a truncated one as zeros.
//
// The first directory, as libtiff reads it, gives the start and the number of bytes of each strip
// or tile. The file is whole if none that its pixels need is missing or empty and each ends within
// the file. For a single strip whose number of bytes is missing, or too small for its pixels,
// libtiff estimates it: such a file is refused. Sizes are limited by decoded_size.h.
//
// If strips or tiles are deflated, each ends with a checksum of its bytes, Adler-32. libtiff stops
// at the last pixel, and OpenImageIO 2.4 treats a strip that does not unpack as zeros, so the
// streams are unpacked here as a check.
#pragma once

#include <filesystem>

namespace aphotic {

// An InputError without the file's name if it is incomplete.
void require_whole_tiff(const std::filesystem::path& file);

// The same for a complete file if a deflated strip or tile is damaged. Takes the time of unpacking.
void require_sound_streams(const std::filesystem::path& file);

}  // namespace aphotic
