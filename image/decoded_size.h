// SPDX-License-Identifier: BSD-3-Clause
//
// Limits on the memory that a file may require, checked by its header before a pixel is decoded. A
// header can claim any size, and decoders trust it.
//
// A file has up to 32768 pixels each way, two images of the largest size side by side; its tiles,
// padded to full tiles, take up to 4 times its bytes plus 64 MiB; a block decoded at once takes up
// to 256 MiB. Besides pixels a file has up to 256 MiB of metadata, thumbnails and further images.
// To exclude decompression bombs: deflate, the strongest compression in use, expands a byte to at
// most 1032, so the file of an image over 1 GiB, as floats, must have at least 1/1100 of that. A
// reader thus uses the memory of the image that the header declares, and less than 1 GiB more;
// callers that know the expected size check it first.
//
// Messages do not name the file; the caller does.
#pragma once

#include "base/error.h"
#include "image/image_size.h"

#include <cstdint>
#include <limits>

namespace aphotic {

struct BigSize {
    std::uint64_t width = 0;
    std::uint64_t height = 0;
};

// The largest number if it overflows: no file has as many bytes.
[[nodiscard]] constexpr std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    return b != 0 && a > kMost / b ? kMost : a * b;
}

[[nodiscard]] constexpr std::uint64_t quotient_up(std::uint64_t number, std::uint64_t by) {
    return number / by + (number % by != 0 ? 1 : 0);
}

inline constexpr std::uint64_t kMebi = std::uint64_t{1} << 20U;

// For files from which only metadata is read, since libraries allocate the declared size.
inline constexpr std::uint64_t kMostOfNotes_bytes = 512 * kMebi;

inline void require_sides(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t kMost = std::int64_t{2} * kLargestImagePx;
    const auto is_side = [](std::int64_t side) { return side > 0 && side <= kMost; };
    if (is_side(width) && is_side(height)) return;
    throw InputError("found {} x {} pixels; allowed: 1 to {} each way", width, height, kMost);
}

// Rows that a decoder holds at once.
inline void require_block(std::uint64_t width, std::uint64_t rows, std::uint64_t pixel_bytes) {
    constexpr std::uint64_t kMost_bytes = 256 * kMebi;
    const std::uint64_t bytes = product(product(width, rows), pixel_bytes);
    if (bytes <= kMost_bytes) return;
    throw InputError("found {} rows decoded at once, {} MiB in all; allowed: {} MiB",
                     rows,
                     bytes / kMebi,
                     kMost_bytes / kMebi);
}

inline void require_tiles(BigSize image, BigSize tile, std::uint64_t pixel_bytes) {
    constexpr std::uint64_t kMostTimes = 4;
    constexpr std::uint64_t kAlways_bytes = 64 * kMebi;
    const auto padded = [](std::uint64_t side, std::uint64_t by) {
        return product(quotient_up(side, by), by);
    };
    const std::uint64_t tiled = product(
        product(padded(image.width, tile.width), padded(image.height, tile.height)), pixel_bytes);
    const std::uint64_t own = product(product(image.width, image.height), pixel_bytes);
    if (tiled <= kAlways_bytes || tiled / kMostTimes <= own) return;
    throw InputError("found tiles of {} x {} pixels for an image of {} x {}",
                     tile.width,
                     tile.height,
                     image.width,
                     image.height);
}

// image_bytes: all samples as stored, uncompressed.
inline void require_file_size(std::uint64_t file_bytes,
                              std::uint64_t image_bytes,
                              std::uint64_t samples) {
    constexpr std::uint64_t kMostBeside_bytes = 256 * kMebi;
    constexpr std::uint64_t kAlways_bytes = 1024 * kMebi;
    constexpr std::uint64_t kMostTimes = 1100;
    if (file_bytes > kMostBeside_bytes && file_bytes - kMostBeside_bytes > image_bytes) {
        throw InputError("found {} MiB in the file for {} MiB of pixels; allowed: {} MiB more",
                         file_bytes / kMebi,
                         image_bytes / kMebi,
                         kMostBeside_bytes / kMebi);
    }
    if (product(samples, sizeof(float)) > kAlways_bytes && image_bytes / kMostTimes > file_bytes) {
        throw InputError("found {} bytes in the file for {} MiB of pixels; needed: 1/{} or more",
                         file_bytes,
                         image_bytes / kMebi,
                         kMostTimes);
    }
}

}  // namespace aphotic
