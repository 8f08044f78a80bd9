// SPDX-License-Identifier: BSD-3-Clause
//
// A 16-bit TIFF file of one plane, as cameras write their mosaics: TIFF 6.0, uncompressed or by
// PackBits, one strip, little-endian.
#pragma once

#include "support/tiff_writer.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// PackBits without repetitions: runs of up to 128 bytes after their length less one.
inline std::string packed_bits(const std::string& bytes, std::size_t row_bytes) {
    constexpr std::size_t kMostRun = 128;
    std::string packed;
    for (std::size_t row = 0; row < bytes.size(); row += row_bytes) {
        for (std::size_t at = 0; at < row_bytes; at += kMostRun) {
            const std::size_t run = std::min(kMostRun, row_bytes - at);
            packed += static_cast<char>(run - 1);
            packed += bytes.substr(row + at, run);
        }
    }
    packed.append(packed.size() % 2, '\0');
    return packed;
}

inline std::string tiff_of(const std::vector<std::uint16_t>& samples,
                           std::uint32_t width,
                           std::uint32_t height,
                           std::string_view description,
                           bool directory_first = false,
                           bool is_packed = false) {
    std::string pixels;
    for (const std::uint16_t sample : samples) put_little(pixels, sample, 2);
    TiffWriter tiff;
    tiff.longs(256, {width});
    tiff.longs(257, {height});
    tiff.shorts(258, {16});  // bits a sample
    tiff.shorts(259, {is_packed ? 32773U : 1U});
    tiff.shorts(262, {1});  // 0 is black
    tiff.text(270, std::string(description));
    tiff.shorts(277, {1});
    tiff.longs(278, {height});
    return tiff.file(
        is_packed ? packed_bits(pixels, 2UL * width) : pixels,
        directory_first ? TiffOrder::DirectoryPixelsValues : TiffOrder::PixelsValuesDirectory);
}

}  // namespace aphotic
