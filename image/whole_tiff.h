// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the pixels of a TIFF file are all in it, by its own directory: libtiff reads the missing
// rows of one that was cut short as zeros.
//
// The first directory, as libtiff reads it, tells where each strip or tile begins and how many
// bytes it has. The file is whole when none that its pixels need is missing or empty and each ends
// within the file. Of a single strip whose bytes are not told, or too few for its pixels, libtiff
// makes up how many there are: such a file is refused. Sizes are held to decoded_size.h.
//
// Where strips or tiles are deflated, each ends with a checksum of its bytes, Adler-32. libtiff
// stops at the last pixel, and OpenImageIO 2.4 takes a strip that does not unpack for one of zeros:
// so the streams are unpacked here, to see.
#pragma once

#include <filesystem>

namespace aphotic {

// An InputError without the file's name if it is incomplete.
void require_whole_tiff(const std::filesystem::path& file);

// The same for a complete file if a deflated strip or tile is damaged. Takes the time of unpacking.
void require_sound_streams(const std::filesystem::path& file);

}  // namespace aphotic
