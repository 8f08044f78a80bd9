// SPDX-License-Identifier: BSD-3-Clause
#include "cli/whole_tiff.h"

#include "spectral/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace aphotic::cli {

namespace {

class Tiff {
  public:
    explicit Tiff(const std::filesystem::path& file)
        : stream_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {
        constexpr std::uint64_t kBigVersion = 43;
        const std::string mark = bytes(0, 2);
        is_big_endian_ = mark == "MM";
        is_bigtiff_ = number(2, 2) == kBigVersion;
    }

    // Of each strip or tile: where it begins, or how many bytes it has.
    [[nodiscard]] std::vector<std::uint64_t> values(std::uint64_t strips, std::uint64_t tiles) {
        const std::uint64_t directory = is_bigtiff_ ? number(8, 8) : number(4, 4);
        const std::uint64_t entries = number(directory, is_bigtiff_ ? 8 : 2);
        const std::uint64_t first = directory + (is_bigtiff_ ? 8 : 2);
        const std::uint64_t step = is_bigtiff_ ? 20 : 12;
        require_within(first, entries, step);
        for (std::uint64_t at = first; at < first + entries * step; at += step) {
            const std::uint64_t tag = number(at, 2);
            if (tag == strips || tag == tiles) return values_of(at);
        }
        return {};
    }

    void require_end(std::uint64_t offset, std::uint64_t count) const {
        if (count <= size_ && offset <= size_ - count) return;
        throw InputError(
            fmt::format("it is cut short: found {} bytes of {} and more", size_, offset + count));
    }

  private:
    [[nodiscard]] std::vector<std::uint64_t> values_of(std::uint64_t entry) {
        constexpr std::uint64_t kShort = 3;
        constexpr std::uint64_t kLong8 = 16;
        const std::uint64_t word = is_bigtiff_ ? 8 : 4;
        const std::uint64_t type = number(entry + 2, 2);
        const std::uint64_t each = type == kShort ? 2 : (type == kLong8 ? 8 : 4);
        const std::uint64_t count = number(entry + 4, word);
        const std::uint64_t here = entry + 4 + word;
        const std::uint64_t start = count <= word / each ? here : number(here, word);
        require_within(start, count, each);
        const std::string all = bytes(start, count * each);
        std::vector<std::uint64_t> values(count);
        for (std::uint64_t i = 0; i < count; ++i) values[i] = number_in(all, i * each, each);
        return values;
    }

    void require_within(std::uint64_t offset, std::uint64_t count, std::uint64_t each) const {
        require_end(offset, std::min(count, size_ + 1) * each);
    }

    [[nodiscard]] std::string bytes(std::uint64_t offset, std::uint64_t count) {
        require_end(offset, count);
        std::string read(count, '\0');
        stream_.seekg(static_cast<std::streamoff>(offset));
        stream_.read(read.data(), static_cast<std::streamsize>(count));
        if (!stream_) throw InputError("it cannot be read to its end");
        return read;
    }

    [[nodiscard]] std::uint64_t number(std::uint64_t offset, std::uint64_t size) {
        return number_in(bytes(offset, size), 0, size);
    }

    [[nodiscard]] std::uint64_t number_in(const std::string& text,
                                          std::uint64_t from,
                                          std::uint64_t size) const {
        constexpr unsigned kByte = 8;
        std::uint64_t number = 0;
        for (std::uint64_t i = 0; i < size; ++i) {
            const std::uint64_t at = from + (is_big_endian_ ? i : size - 1 - i);
            number = number << kByte | static_cast<unsigned char>(text[at]);
        }
        return number;
    }

    std::ifstream stream_;
    std::uint64_t size_;
    bool is_big_endian_ = false;
    bool is_bigtiff_ = false;
};

}  // namespace

void require_whole_tiff(const std::filesystem::path& file) {
    constexpr std::uint64_t kStripOffsets = 273;
    constexpr std::uint64_t kStripBytes = 279;
    constexpr std::uint64_t kTileOffsets = 324;
    constexpr std::uint64_t kTileBytes = 325;
    Tiff tiff(file);
    const std::vector<std::uint64_t> offsets = tiff.values(kStripOffsets, kTileOffsets);
    const std::vector<std::uint64_t> counts = tiff.values(kStripBytes, kTileBytes);
    for (std::size_t i = 0; i < std::min(offsets.size(), counts.size()); ++i) {
        if (counts[i] == 0) {
            throw InputError(
                fmt::format("it is not whole: of {} parts of the image, number {} is empty",
                            counts.size(),
                            i + 1));
        }
        tiff.require_end(offsets[i], counts[i]);
    }
}

}  // namespace aphotic::cli
