// SPDX-License-Identifier: BSD-3-Clause
//
// A raw file as small as Adobe's specification lets it be (Digital Negative 1.4): TIFF,
// little-endian, one uncompressed strip of 16 bits.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace aphotic {

struct Dng {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint16_t> samples{};           // row by row; of colours side by side
    std::vector<std::uint8_t> pattern{0, 1, 1, 2};  // red 0, green 1, blue 2; none: not a mosaic
    std::uint16_t colours = 1;                      // of a pixel
    std::vector<std::uint32_t> black{};             // one, or four of two by two sites
    std::uint32_t white = 0;                        // 0: not told
    std::vector<std::uint32_t> active_area{};       // top, left, bottom, right
    std::uint32_t exposure_ms = 0;                  // 0: not told
    std::uint16_t iso = 0;
};

class DngWriter {
  public:
    static std::string bytes(const Dng& dng) {
        DngWriter writer;
        std::string pixels;
        for (const std::uint16_t sample : dng.samples) put(pixels, sample, 2);
        const bool is_mosaic = !dng.pattern.empty();
        writer.longs(254, {0});
        writer.longs(256, {dng.width});
        writer.longs(257, {dng.height});
        writer.shorts(258, std::vector<std::uint16_t>(dng.colours, 16));
        writer.shorts(259, {1});
        writer.shorts(262, {static_cast<std::uint16_t>(is_mosaic ? 32803 : 34892)});
        writer.text(271, "Acme");
        writer.text(272, "Deep 1");
        writer.longs(273, {0});  // where the pixels are: known at the end
        writer.shorts(274, {1});
        writer.shorts(277, {dng.colours});
        writer.longs(278, {dng.height});
        writer.longs(279, {static_cast<std::uint32_t>(pixels.size())});
        writer.shorts(284, {1});
        if (is_mosaic) {
            writer.shorts(33421, {2, 2});
            writer.raw_bytes(33422, dng.pattern);
        }
        if (dng.exposure_ms > 0) writer.rationals(33434, 5, {dng.exposure_ms, 1000});
        if (dng.iso > 0) writer.shorts(34855, {dng.iso});
        writer.raw_bytes(50706, {1, 4, 0, 0});
        writer.raw_bytes(50707, {1, 1, 0, 0});
        writer.text(50708, "Acme Deep 1");
        if (is_mosaic) {
            writer.raw_bytes(50710, {0, 1, 2});
            writer.shorts(50711, {1});
        }
        if (dng.black.size() > 1) writer.shorts(50713, {2, 2});
        if (!dng.black.empty()) writer.longs(50714, dng.black);
        if (dng.white > 0) writer.longs(50717, std::vector<std::uint32_t>(dng.colours, dng.white));
        writer.rationals(50721, 10, {1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1});
        writer.rationals(50728, 5, {1, 1, 1, 1, 1, 1});
        writer.shorts(50778, {21});
        if (!dng.active_area.empty()) writer.longs(50829, dng.active_area);
        return writer.file(pixels);
    }

  private:
    struct Entry {
        std::uint32_t type;
        std::uint32_t count;
        std::string bytes;
    };

    static void put(std::string& bytes, std::uint32_t number, unsigned size) {
        for (unsigned i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * i & 0xFFU);
    }
    void shorts(std::uint32_t tag, const std::vector<std::uint16_t>& numbers) {
        Entry entry{3, static_cast<std::uint32_t>(numbers.size()), ""};
        for (const std::uint16_t number : numbers) put(entry.bytes, number, 2);
        entries_[tag] = entry;
    }
    void longs(std::uint32_t tag, const std::vector<std::uint32_t>& numbers) {
        Entry entry{4, static_cast<std::uint32_t>(numbers.size()), ""};
        for (const std::uint32_t number : numbers) put(entry.bytes, number, 4);
        entries_[tag] = entry;
    }
    void rationals(std::uint32_t tag, std::uint32_t type, const std::vector<std::uint32_t>& pairs) {
        longs(tag, pairs);
        entries_[tag].type = type;
        entries_[tag].count /= 2;
    }
    void raw_bytes(std::uint32_t tag, const std::vector<std::uint8_t>& bytes) {
        entries_[tag] = {
            1, static_cast<std::uint32_t>(bytes.size()), std::string(bytes.begin(), bytes.end())};
    }
    void text(std::uint32_t tag, const std::string& words) {
        entries_[tag] = {2, static_cast<std::uint32_t>(words.size() + 1), words + '\0'};
    }

    // Header, directory, what does not fit into it, pixels.
    std::string file(const std::string& pixels) {
        constexpr std::uint32_t kHeaderBytes = 8;
        const auto count = static_cast<std::uint32_t>(entries_.size());
        const std::uint32_t more_at = kHeaderBytes + 2 + 12 * count + 4;
        std::uint32_t more_bytes = 0;
        for (const auto& [tag, entry] : entries_) more_bytes += outside(entry);
        entries_[273].bytes.clear();
        put(entries_[273].bytes, more_at + more_bytes, 4);
        std::string head = "II*";
        head += '\0';
        put(head, kHeaderBytes, 4);
        put(head, count, 2);
        std::string more;
        for (const auto& [tag, entry] : entries_) {
            put(head, tag, 2);
            put(head, entry.type, 2);
            put(head, entry.count, 4);
            if (outside(entry) == 0) {
                head += entry.bytes + std::string(4 - entry.bytes.size(), '\0');
            } else {
                put(head, more_at + static_cast<std::uint32_t>(more.size()), 4);
                more += entry.bytes + std::string(entry.bytes.size() % 2, '\0');
            }
        }
        put(head, 0, 4);
        return head + more + pixels;
    }
    static std::uint32_t outside(const Entry& entry) {
        const auto bytes = static_cast<std::uint32_t>(entry.bytes.size());
        return bytes > 4 ? bytes + bytes % 2 : 0;
    }

    std::map<std::uint32_t, Entry> entries_;
};

}  // namespace aphotic
