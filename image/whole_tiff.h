// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the pixels of a TIFF file are all in it, by its own directory: libtiff reads the missing
// rows of one that was cut short as zeros.
//
// TIFF 6.0 and BigTIFF. The first directory tells where each strip or tile begins and how many
// bytes it has: offsets (tags 273, 324) and byte counts (279, 325). The file is whole when it has
// as many of both as its pixels need, by width, height, rows a strip or the tiles' sizes, and
// separate planes; when each ends within the file and none is empty. Sizes are held to
// decoded_size.h. What the bytes mean is left to libtiff.
//
// Where strips or tiles are deflated, each ends with a checksum of its bytes, Adler-32. libtiff
// stops at the last pixel, and OpenImageIO 2.4 takes a strip that does not unpack for one of zeros:
// so the streams are unpacked here, to see.
#pragma once

#include <filesystem>

namespace aphotic {

// An InputError that does not name the file, when it is not whole.
void require_whole_tiff(const std::filesystem::path& file);

// The same, of a whole one, when a deflated strip or tile is damaged. Takes the time of unpacking.
void require_sound_streams(const std::filesystem::path& file);

}  // namespace aphotic
