// SPDX-License-Identifier: BSD-3-Clause
#include "image/whole_tiff.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
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
    }

    // The numbers of those tags of the first directory that are asked for. Of a tag that stands
    // twice the first counts, as with libtiff.
    [[nodiscard]] std::map<std::uint64_t, std::vector<std::uint64_t>> values(
        std::span<const std::uint64_t> wanted) {
        const std::uint64_t directory = is_bigtiff_ ? number(8, 8) : number(4, 4);
        const std::uint64_t entries = number(directory, is_bigtiff_ ? 8 : 2);
        const std::uint64_t first = directory + (is_bigtiff_ ? 8 : 2);
        const std::uint64_t step = is_bigtiff_ ? 20 : 12;
        require_end(first, product(entries, step));
        std::map<std::uint64_t, std::vector<std::uint64_t>> values;
        for (std::uint64_t at = first; at < first + entries * step; at += step) {
            const std::uint64_t tag = number(at, 2);
            if (std::ranges::find(wanted, tag) == wanted.end() || values.contains(tag)) continue;
            values[tag] = values_of(at);
        }
        return values;
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
constexpr std::array kTags{kWidth,
                           kHeight,
                           kStripOffsets,
                           kSamplesPerPixel,
                           kRowsPerStrip,
                           kStripBytes,
                           kPlanarConfig,
                           kTileWidth,
                           kTileHeight,
                           kTileOffsets,
                           kTileBytes};

class Tags {
  public:
    explicit Tags(std::map<std::uint64_t, std::vector<std::uint64_t>> values)
        : values_(std::move(values)) {}

    [[nodiscard]] bool has(std::uint64_t tag) const { return values_.contains(tag); }

    [[nodiscard]] const std::vector<std::uint64_t>& all(std::uint64_t tag) const {
        const auto found = values_.find(tag);
        if (found != values_.end()) return found->second;
        throw InputError("it is not whole: the tag {} is missing", tag);
    }

    // 1 and more.
    [[nodiscard]] std::uint64_t one(std::uint64_t tag) const {
        const std::vector<std::uint64_t>& values = all(tag);
        if (values.empty() || values[0] == 0) {
            throw InputError("it is not whole: the tag {} is 0 or empty", tag);
        }
        return values[0];
    }

    [[nodiscard]] std::uint64_t one(std::uint64_t tag, std::uint64_t usual) const {
        return has(tag) ? one(tag) : usual;
    }

  private:
    std::map<std::uint64_t, std::vector<std::uint64_t>> values_;
};

std::uint64_t quotient_up(std::uint64_t number, std::uint64_t by) {
    return number / by + (number % by != 0 ? 1 : 0);
}

std::uint64_t planes_of(const Tags& tags) {
    constexpr std::uint64_t kSeparate = 2;
    return tags.one(kPlanarConfig, 1) == kSeparate ? tags.one(kSamplesPerPixel, 1) : 1;
}

std::uint64_t strips_of(const Tags& tags) {
    return product(quotient_up(tags.one(kHeight), tags.one(kRowsPerStrip, kMost)), planes_of(tags));
}

std::uint64_t tiles_of(const Tags& tags) {
    return product(product(quotient_up(tags.one(kWidth), tags.one(kTileWidth)),
                           quotient_up(tags.one(kHeight), tags.one(kTileHeight))),
                   planes_of(tags));
}

}  // namespace

void require_whole_tiff(const std::filesystem::path& file) {
    Tiff tiff(file);
    const Tags tags(tiff.values(kTags));
    const bool is_tiled = tags.has(kTileWidth) || tags.has(kTileOffsets);
    const std::vector<std::uint64_t>& offsets = tags.all(is_tiled ? kTileOffsets : kStripOffsets);
    const std::vector<std::uint64_t>& sizes = tags.all(is_tiled ? kTileBytes : kStripBytes);
    const std::uint64_t parts = is_tiled ? tiles_of(tags) : strips_of(tags);
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
