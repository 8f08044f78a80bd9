// SPDX-License-Identifier: BSD-3-Clause
//
// A TIFF file byte by byte (TIFF 6.0): one directory of any tags, in either order of bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace aphotic {

inline void put_little(std::string& bytes, std::uint64_t number, unsigned size) {
    for (unsigned i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * i & 0xFFU);
}

inline void put_big(std::string& bytes, std::uint64_t number, unsigned size) {
    for (unsigned i = size; i-- > 0;) bytes += static_cast<char>(number >> 8 * i & 0xFFU);
}

// What follows the header; values are what does not fit into the directory.
enum class TiffOrder { DirectoryValuesPixels, DirectoryPixelsValues, PixelsValuesDirectory };

class TiffWriter {
  public:
    explicit TiffWriter(bool is_big_endian = false)
        : put_(is_big_endian ? put_big : put_little), letters_(is_big_endian ? "MM" : "II") {}

    void shorts(std::uint16_t tag, const std::vector<std::uint32_t>& numbers) {
        add(tag, 3, numbers.size(), joined(numbers, 2));
    }
    void longs(std::uint16_t tag, const std::vector<std::uint32_t>& numbers) {
        add(tag, 4, numbers.size(), joined(numbers, 4));
    }
    // Of type 5, or 10 for signed ones.
    void rationals(std::uint16_t tag,
                   std::uint16_t type,
                   const std::vector<std::uint32_t>& numbers) {
        add(tag, type, numbers.size() / 2, joined(numbers, 4));
    }
    void text(std::uint16_t tag, const std::string& words) {
        add(tag, 2, words.size() + 1, words + '\0');
    }
    // Bytes in the file's order.
    void add(std::uint16_t tag, std::uint16_t type, std::size_t count, const std::string& bytes) {
        entries_[tag] = {type, count, bytes};
    }

    // The pixels are one strip, or a tile if there is a tag of its width; with their place, and
    // their size unless it was said.
    std::string file(const std::string& pixels, TiffOrder order) {
        const bool is_tiled = entries_.contains(322);
        const auto pixel_bytes = static_cast<std::uint32_t>(pixels.size());
        if (!entries_.contains(is_tiled ? 325 : 279)) longs(is_tiled ? 325 : 279, {pixel_bytes});
        longs(is_tiled ? 324 : 273, {0});
        constexpr std::uint32_t kHeaderBytes = 8;
        const auto directory_bytes = static_cast<std::uint32_t>(2 + 12 * entries_.size() + 4);
        std::uint32_t value_bytes = 0;
        for (const auto& [tag, entry] : entries_)
            if (entry.bytes.size() > 4) value_bytes += even(entry.bytes.size());
        const bool is_last = order == TiffOrder::PixelsValuesDirectory;
        const std::uint32_t behind = kHeaderBytes + (is_last ? 0 : directory_bytes);
        const bool is_behind_values = order == TiffOrder::DirectoryValuesPixels;
        const std::uint32_t pixels_at = behind + (is_behind_values ? value_bytes : 0);
        const std::uint32_t values_at = behind + (is_behind_values ? 0 : even(pixels.size()));
        longs(is_tiled ? 324 : 273, {pixels_at});

        std::string header = letters_;
        put_(header, 42, 2);
        put_(header, is_last ? values_at + value_bytes : kHeaderBytes, 4);
        std::string directory;
        std::string values;
        put_(directory, entries_.size(), 2);
        for (const auto& [tag, entry] : entries_) {
            put_(directory, tag, 2);
            put_(directory, entry.type, 2);
            put_(directory, entry.count, 4);
            if (entry.bytes.size() > 4) {
                put_(directory, values_at + values.size(), 4);
                values += entry.bytes + std::string(entry.bytes.size() % 2, '\0');
            } else {
                directory += entry.bytes + std::string(4 - entry.bytes.size(), '\0');
            }
        }
        put_(directory, 0, 4);
        if (is_behind_values) return header + directory + values + pixels;
        values.insert(0, pixels + std::string(pixels.size() % 2, '\0'));
        return is_last ? header + values + directory : header + directory + values;
    }

  private:
    struct Entry {
        std::uint16_t type;
        std::size_t count;
        std::string bytes;
    };

    static std::uint32_t even(std::size_t bytes) {
        return static_cast<std::uint32_t>(bytes + bytes % 2);
    }
    [[nodiscard]] std::string joined(const std::vector<std::uint32_t>& numbers,
                                     unsigned size) const {
        std::string bytes;
        for (const std::uint32_t number : numbers) put_(bytes, number, size);
        return bytes;
    }

    void (*put_)(std::string& bytes, std::uint64_t number, unsigned size);
    std::string letters_;
    std::map<std::uint16_t, Entry> entries_;
};

}  // namespace aphotic
