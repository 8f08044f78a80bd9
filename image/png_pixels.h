// SPDX-License-Identifier: BSD-3-Clause
//
// PNG files, decoded by libpng itself: through OpenImageIO, libpng prints every error on its own
// line of stderr, and takes a height of a million rows from a header.
//
// Palettes become colours, transparency a channel, and samples of fewer than 8 bits ones of 8.
// Every chunk has a checksum, which libpng looks at; one that is wrong is an error where pixels
// depend on it.
#pragma once

#include <filesystem>
#include <vector>

namespace aphotic {

// By its first bytes.
[[nodiscard]] bool is_png(const std::filesystem::path& file);

// An InputError that does not name the file: libpng's words.
void require_sound_png_header(const std::filesystem::path& file);

// Of a file of so many pixels and channels, those channels from `first` up to, and without, `end`.
struct PngPart {
    int width_px = 0;
    int height_px = 0;
    int channels = 0;
    int first = 0;
    int end = 0;
};

// Row by row, channels side by side, 0 to 1. An InputError as above, also when the file is another
// by now.
[[nodiscard]] std::vector<float> png_pixels(const std::filesystem::path& file, const PngPart& part);

}  // namespace aphotic
