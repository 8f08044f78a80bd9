// SPDX-License-Identifier: BSD-3-Clause
//
// A 16-bit TIFF file of one plane, as cameras write their mosaics: TIFF 6.0, uncompressed or by
// PackBits, one strip, little-endian.
#pragma once

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
    const auto put = [](std::string& bytes, std::uint32_t number, int size) {
        for (int i = 0; i < size; ++i) {
            bytes += static_cast<char>(number >> static_cast<unsigned>(8 * i) & 0xFFU);
        }
    };
    constexpr std::uint32_t kHeaderBytes = 8;
    constexpr std::uint32_t kDirectoryBytes = 2 + 10 * 12 + 4;
    std::string data;
    for (const std::uint16_t sample : samples) put(data, sample, 2);
    if (is_packed) data = packed_bits(data, 2UL * width);
    const auto pixel_bytes = static_cast<std::uint32_t>(data.size());
    const auto text_bytes = static_cast<std::uint32_t>(description.size() + 1);
    const std::uint32_t even_text = text_bytes + text_bytes % 2;
    const std::uint32_t pixels_at = kHeaderBytes + (directory_first ? kDirectoryBytes : 0);
    data += description;
    data.append(even_text - description.size(), '\0');
    std::string header = "II";
    put(header, 42, 2);
    put(header, directory_first ? kHeaderBytes : kHeaderBytes + pixel_bytes + even_text, 4);
    struct Entry {
        std::uint32_t tag, type, count, value;
    };
    constexpr std::uint32_t kText = 2;
    constexpr std::uint32_t kShort = 3;
    constexpr std::uint32_t kLong = 4;
    const std::uint32_t compression = is_packed ? 32773 : 1;
    const std::vector<Entry> entries{{256, kLong, 1, width},
                                     {257, kLong, 1, height},
                                     {258, kShort, 1, 16},  // bits a sample
                                     {259, kShort, 1, compression},
                                     {262, kShort, 1, 1},  // 0 is black
                                     {270, kText, text_bytes, pixels_at + pixel_bytes},
                                     {273, kLong, 1, pixels_at},
                                     {277, kShort, 1, 1},
                                     {278, kLong, 1, height},
                                     {279, kLong, 1, pixel_bytes}};
    std::string directory;
    put(directory, static_cast<std::uint32_t>(entries.size()), 2);
    for (const Entry& entry : entries) {
        put(directory, entry.tag, 2);
        put(directory, entry.type, 2);
        put(directory, entry.count, 4);
        put(directory, entry.value, 4);  // a short's two bytes come first, then zeros
    }
    put(directory, 0, 4);
    return directory_first ? header + directory + data : header + data + directory;
}

}  // namespace aphotic
