// SPDX-License-Identifier: BSD-3-Clause
//
// PNG files, decoded by libpng directly: through OpenImageIO, libpng prints every error as a line
// on stderr, and trusts a header's height of a million rows.
//
// Palettes are expanded to colours, transparency to a channel, and samples of fewer than 8 bits to
// 8. libpng checks every chunk's checksum; a wrong one is an error if pixels depend on it.
#pragma once

#include <filesystem>
#include <vector>

namespace aphotic {

// Whether the first bytes are PNG's.
[[nodiscard]] bool is_png(const std::filesystem::path& file);

// An InputError without the file's name: libpng's message.
void require_sound_png_header(const std::filesystem::path& file);

// For a file of this many pixels and channels: the channels from `first` up to but not including
// `end`.
struct PngPart {
    int width_px = 0;
    int height_px = 0;
    int channels = 0;
    int first = 0;
    int end = 0;
};

// Row by row, channels interleaved, 0 to 1. An InputError as above, also if the file has changed.
[[nodiscard]] std::vector<float> png_pixels(const std::filesystem::path& file, const PngPart& part);

}  // namespace aphotic
