// SPDX-License-Identifier: BSD-3-Clause
#include "image/whole_tiff.h"

#include "base/error.h"

#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace aphotic {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

// kMost where it is larger: no file has as many bytes.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    return b != 0 && a > kMost / b ? kMost : a * b;
}

std::uint64_t bytes_of_type(std::uint64_t type) {
    static const std::map<std::uint64_t, std::uint64_t> kBytes{
        {1, 1}, {3, 2}, {4, 4}, {13, 4}, {16, 8}, {18, 8}};
    const auto found = kBytes.find(type);
    if (found != kBytes.end()) return found->second;
    throw InputError("it has numbers of the type {} where integers belong", type);
}

class Tiff {
  public:
    explicit Tiff(const std::filesystem::path& file)
        : stream_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {
        constexpr std::uint64_t kBigVersion = 43;
        const std::string mark = bytes(0, 2);
        is_big_endian_ = mark == "MM";
        is_bigtiff_ = number(2, 2) == kBigVersion;
        const std::uint64_t directory = is_bigtiff_ ? number(8, 8) : number(4, 4);
        const std::uint64_t entries = number(directory, is_bigtiff_ ? 8 : 2);
        const std::uint64_t first = directory + (is_bigtiff_ ? 8 : 2);
        const std::uint64_t step = is_bigtiff_ ? 20 : 12;
        require_end(first, product(entries, step));
        // Of a tag that stands twice the first counts, as with libtiff.
        for (std::uint64_t at = first; at < first + entries * step; at += step) {
            entries_.emplace(number(at, 2), at);
        }
    }

    // Of the first directory.
    [[nodiscard]] bool has(std::uint64_t tag) const { return entries_.contains(tag); }

    [[nodiscard]] std::vector<std::uint64_t> all(std::uint64_t tag) {
        const auto found = entries_.find(tag);
        if (found != entries_.end()) return values_of(found->second);
        throw InputError("it is not whole: the tag {} is missing", tag);
    }

    // 1 and more.
    [[nodiscard]] std::uint64_t one(std::uint64_t tag) {
        const std::vector<std::uint64_t> values = all(tag);
        if (!values.empty() && values[0] != 0) return values[0];
        throw InputError("it is not whole: the tag {} is 0 or empty", tag);
    }

    [[nodiscard]] std::uint64_t one(std::uint64_t tag, std::uint64_t usual) {
        return has(tag) ? one(tag) : usual;
    }

    void require_end(std::uint64_t offset, std::uint64_t count) const {
        if (count <= size_ && offset <= size_ - count) return;
        if (count > kMost - offset) throw InputError("it points beyond its end");
        throw InputError("it is cut short: found {} bytes of {} and more", size_, offset + count);
    }

  private:
    [[nodiscard]] std::vector<std::uint64_t> values_of(std::uint64_t entry) {
        const std::uint64_t word = is_bigtiff_ ? 8 : 4;
        const std::uint64_t each = bytes_of_type(number(entry + 2, 2));
        const std::uint64_t count = number(entry + 4, word);
        const std::uint64_t here = entry + 4 + word;
        const std::uint64_t start = count <= word / each ? here : number(here, word);
        const std::string all = bytes(start, product(count, each));
        std::vector<std::uint64_t> values(count);
        for (std::uint64_t i = 0; i < count; ++i) values[i] = number_in(all, i * each, each);
        return values;
    }

    [[nodiscard]] std::string bytes(std::uint64_t offset, std::uint64_t count) {
        require_end(offset, count);
        std::string read(count, '\0');
        stream_.seekg(static_cast<std::streamoff>(offset));
        stream_.read(read.data(), static_cast<std::streamsize>(count));
        if (!stream_) throw InputError("it cannot be read to the end");
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
    std::map<std::uint64_t, std::uint64_t> entries_;  // where each stands, by tag
    bool is_big_endian_ = false;
    bool is_bigtiff_ = false;
};

constexpr std::uint64_t kWidth = 256;
constexpr std::uint64_t kHeight = 257;
constexpr std::uint64_t kStripOffsets = 273;
constexpr std::uint64_t kSamplesPerPixel = 277;
constexpr std::uint64_t kRowsPerStrip = 278;
constexpr std::uint64_t kStripBytes = 279;
constexpr std::uint64_t kPlanarConfig = 284;
constexpr std::uint64_t kTileWidth = 322;
constexpr std::uint64_t kTileHeight = 323;
constexpr std::uint64_t kTileOffsets = 324;
constexpr std::uint64_t kTileBytes = 325;
std::uint64_t quotient_up(std::uint64_t number, std::uint64_t by) {
    return number / by + (number % by != 0 ? 1 : 0);
}

std::uint64_t planes_of(Tiff& tiff) {
    constexpr std::uint64_t kSeparate = 2;
    return tiff.one(kPlanarConfig, 1) == kSeparate ? tiff.one(kSamplesPerPixel, 1) : 1;
}

std::uint64_t strips_of(Tiff& tiff) {
    return product(quotient_up(tiff.one(kHeight), tiff.one(kRowsPerStrip, kMost)), planes_of(tiff));
}

std::uint64_t tiles_of(Tiff& tiff) {
    return product(product(quotient_up(tiff.one(kWidth), tiff.one(kTileWidth)),
                           quotient_up(tiff.one(kHeight), tiff.one(kTileHeight))),
                   planes_of(tiff));
}

}  // namespace

void require_whole_tiff(const std::filesystem::path& file) {
    Tiff tiff(file);
    const bool is_tiled = tiff.has(kTileWidth) || tiff.has(kTileOffsets);
    const std::vector<std::uint64_t> offsets = tiff.all(is_tiled ? kTileOffsets : kStripOffsets);
    const std::vector<std::uint64_t> sizes = tiff.all(is_tiled ? kTileBytes : kStripBytes);
    const std::uint64_t parts = is_tiled ? tiles_of(tiff) : strips_of(tiff);
    if (offsets.size() != sizes.size() || offsets.size() < parts) {
        throw InputError(
            "it is not whole: found {} offsets and {} sizes of strips or tiles; needed: {}",
            offsets.size(),
            sizes.size(),
            parts);
    }
    for (std::uint64_t i = 0; i < parts; ++i) {
        if (sizes[i] == 0) {
            throw InputError("it is not whole: strip or tile {} of {} is empty", i + 1, parts);
        }
        tiff.require_end(offsets[i], sizes[i]);
    }
}

}  // namespace aphotic
