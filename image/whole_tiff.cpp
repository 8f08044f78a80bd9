// SPDX-License-Identifier: BSD-3-Clause
#include "image/whole_tiff.h"

#include "base/error.h"
#include "image/decoded_size.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <new>
#include <span>
#include <string>
#include <vector>

namespace aphotic {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

std::uint64_t bytes_of_type(std::uint64_t type) {
    static const std::map<std::uint64_t, std::uint64_t> kBytes{
        {1, 1}, {3, 2}, {4, 4}, {13, 4}, {16, 8}, {18, 8}};
    const auto found = kBytes.find(type);
    if (found != kBytes.end()) return found->second;
    throw InputError("it has numbers of the type {} where integers belong", type);
}

// As libtiff takes; and of tiles of 16 x 16 more than any image has.
constexpr std::uint64_t kMostTags = 4096;
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 23U;

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
        if (entries > kMostTags) {
            throw InputError("found {} tags; allowed: {} or less", entries, kMostTags);
        }
        require_end(first, product(entries, step));
        // Of a tag that stands twice the first counts, as with libtiff.
        for (std::uint64_t at = first; at < first + entries * step; at += step) {
            entries_.emplace(number(at, 2), at);
        }
    }

    [[nodiscard]] std::uint64_t size() const { return size_; }

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

    [[nodiscard]] std::uint64_t most(std::uint64_t tag, std::uint64_t usual) {
        if (!has(tag)) return usual;
        const std::vector<std::uint64_t> values = all(tag);
        if (!values.empty()) return std::ranges::max(values);
        throw InputError("it is not whole: the tag {} is empty", tag);
    }

    void require_end(std::uint64_t offset, std::uint64_t count) const {
        if (count <= size_ && offset <= size_ - count) return;
        if (count > kMost - offset) throw InputError("it points beyond its end");
        throw InputError("it is cut short: found {} bytes of {} and more", size_, offset + count);
    }

    // From the offset, as many of the bytes as fit into the buffer; how many.
    std::uint64_t read(std::uint64_t offset, std::uint64_t count, std::span<char> buffer) {
        const std::uint64_t many = std::min<std::uint64_t>(count, buffer.size());
        require_end(offset, many);
        stream_.seekg(static_cast<std::streamoff>(offset));
        stream_.read(buffer.data(), static_cast<std::streamsize>(many));
        if (!stream_) throw InputError("it cannot be read to the end");
        return many;
    }

  private:
    [[nodiscard]] std::vector<std::uint64_t> values_of(std::uint64_t entry) {
        const std::uint64_t word = is_bigtiff_ ? 8 : 4;
        const std::uint64_t each = bytes_of_type(number(entry + 2, 2));
        const std::uint64_t count = number(entry + 4, word);
        const std::uint64_t here = entry + 4 + word;
        const std::uint64_t start = count <= word / each ? here : number(here, word);
        if (count > kMostValues) {
            throw InputError("found {} values of a tag; allowed: {} or less", count, kMostValues);
        }
        const std::string all = bytes(start, product(count, each));
        std::vector<std::uint64_t> values(count);
        for (std::uint64_t i = 0; i < count; ++i) values[i] = number_in(all, i * each, each);
        return values;
    }

    [[nodiscard]] std::string bytes(std::uint64_t offset, std::uint64_t count) {
        require_end(offset, count);
        std::string all(count, '\0');
        read(offset, count, all);
        return all;
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
constexpr std::uint64_t kBitsPerSample = 258;
constexpr std::uint64_t kCompression = 259;
constexpr std::uint64_t kFillOrder = 266;
constexpr std::uint64_t kStripOffsets = 273;
constexpr std::uint64_t kSamplesPerPixel = 277;
constexpr std::uint64_t kRowsPerStrip = 278;
constexpr std::uint64_t kStripBytes = 279;
constexpr std::uint64_t kPlanarConfig = 284;
constexpr std::uint64_t kTileWidth = 322;
constexpr std::uint64_t kTileHeight = 323;
constexpr std::uint64_t kTileOffsets = 324;
constexpr std::uint64_t kTileBytes = 325;
constexpr std::uint64_t kImageDepth = 32997;
constexpr std::uint64_t kTileDepth = 32998;

// Strips or tiles: what the directory says of them, where it can be true.
struct Parts {
    std::vector<std::uint64_t> offsets;
    std::vector<std::uint64_t> sizes;
    std::uint64_t needed = 0;   // how many of these the pixels take
    std::uint64_t decoded = 0;  // bytes in one of them, at the most
};

BigSize size_of(Tiff& tiff) {
    const BigSize size{tiff.one(kWidth), tiff.one(kHeight)};
    const auto side = [](std::uint64_t pixels) {
        constexpr std::uint64_t kMostSigned = kMost / 2;
        return static_cast<std::int64_t>(std::min(pixels, kMostSigned));
    };
    require_sides(side(size.width), side(size.height));
    for (const std::uint64_t depth : {kImageDepth, kTileDepth}) {
        if (tiff.one(depth, 1) == 1) continue;
        throw InputError("found a depth of {} pixels; allowed: 1", tiff.one(depth));
    }
    return size;
}

Parts parts_of(Tiff& tiff) {
    constexpr std::uint64_t kSeparate = 2;
    constexpr std::uint64_t kByte = 8;
    const BigSize image = size_of(tiff);
    const std::uint64_t samples = tiff.one(kSamplesPerPixel, 1);
    const bool is_separate = tiff.one(kPlanarConfig, 1) == kSeparate;
    const std::uint64_t planes = is_separate ? samples : 1;
    const std::uint64_t bits = tiff.most(kBitsPerSample, 1);
    const std::uint64_t pixel_bits = product(samples / planes, bits);
    const bool is_tiled = tiff.has(kTileWidth) || tiff.has(kTileOffsets);
    const BigSize part =
        is_tiled ? BigSize{tiff.one(kTileWidth), tiff.one(kTileHeight)}
                 : BigSize{image.width, std::min(image.height, tiff.one(kRowsPerStrip, kMost))};
    const std::uint64_t pixels = product(image.width, image.height);
    require_file_size(tiff.size(),
                      product(pixels, quotient_up(product(samples, bits), kByte)),
                      product(pixels, samples));
    if (is_tiled) require_tiles(image, part, quotient_up(pixel_bits, kByte));
    return {.offsets = tiff.all(is_tiled ? kTileOffsets : kStripOffsets),
            .sizes = tiff.all(is_tiled ? kTileBytes : kStripBytes),
            .needed = product(product(quotient_up(image.width, part.width),
                                      quotient_up(image.height, part.height)),
                              planes),
            .decoded = product(quotient_up(product(part.width, pixel_bits), kByte), part.height)};
}

// Streams of zlib's: Adobe's deflate, the same by its old number, and Pixar's logarithms in it.
bool is_deflated(std::uint64_t compression) {
    constexpr std::array<std::uint64_t, 3> kDeflated{8, 32946, 32909};
    return std::ranges::find(kDeflated, compression) != kDeflated.end();
}

void reverse_bits(std::span<char> bytes) {
    constexpr unsigned kBits = 8;
    for (char& byte : bytes) {
        unsigned reversed = 0;
        for (unsigned bit = 0; bit < kBits; ++bit) {
            reversed = reversed << 1U | (static_cast<unsigned char>(byte) >> bit & 1U);
        }
        byte = static_cast<char>(reversed);
    }
}

// Frees what zlib holds.
class Inflater {
  public:
    Inflater() {
        if (::inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { ::inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    void begin() {
        ::inflateReset(&stream_);
        is_at_end_ = false;
    }

    // Whether the stream has its end and its checksum among these bytes or before them.
    bool take(std::span<char> bytes, std::uint64_t most_bytes) {
        stream_.next_in = reinterpret_cast<Bytef*>(bytes.data());
        stream_.avail_in = static_cast<uInt>(bytes.size());
        while (!is_at_end_) {
            stream_.next_out = room_.data();
            stream_.avail_out = static_cast<uInt>(room_.size());
            const int status = ::inflate(&stream_, Z_NO_FLUSH);
            is_at_end_ = status == Z_STREAM_END;
            const bool wants_more = status == Z_BUF_ERROR;
            if (status == Z_MEM_ERROR) throw std::bad_alloc();
            if (!is_at_end_ && !wants_more && status != Z_OK) {
                throw InputError("{}", stream_.msg != nullptr ? stream_.msg : "it is damaged");
            }
            if (stream_.total_out > most_bytes) {
                throw InputError("it holds more than its {} bytes", most_bytes);
            }
            if (stream_.avail_in == 0 && stream_.avail_out > 0) break;
        }
        return is_at_end_;
    }

  private:
    static constexpr std::size_t kRoom_bytes = std::size_t{1} << 16U;
    z_stream stream_{};
    std::vector<Bytef> room_ = std::vector<Bytef>(kRoom_bytes);
    bool is_at_end_ = false;
};

}  // namespace

void require_whole_tiff(const std::filesystem::path& file) {
    Tiff tiff(file);
    const Parts parts = parts_of(tiff);
    if (parts.offsets.size() != parts.sizes.size() || parts.offsets.size() < parts.needed) {
        throw InputError(
            "it is not whole: found {} offsets and {} sizes of strips or tiles; needed: {}",
            parts.offsets.size(),
            parts.sizes.size(),
            parts.needed);
    }
    for (std::uint64_t i = 0; i < parts.needed; ++i) {
        if (parts.sizes[i] == 0) {
            throw InputError(
                "it is not whole: strip or tile {} of {} is empty", i + 1, parts.needed);
        }
        tiff.require_end(parts.offsets[i], parts.sizes[i]);
    }
}

void require_sound_streams(const std::filesystem::path& file) {
    constexpr std::uint64_t kNone = 1;
    constexpr std::uint64_t kLeastBitFirst = 2;
    constexpr std::uint64_t kMostTimes = 2;  // Pixar's samples have 16 bits, whatever the image's
    constexpr std::size_t kChunk_bytes = std::size_t{1} << 16U;
    Tiff tiff(file);
    if (!is_deflated(tiff.one(kCompression, kNone))) return;
    const Parts parts = parts_of(tiff);
    const bool is_reversed = tiff.one(kFillOrder, 1) == kLeastBitFirst;
    std::vector<char> chunk(kChunk_bytes);
    Inflater inflater;
    for (std::uint64_t i = 0; i < parts.needed; ++i) {
        try {
            inflater.begin();
            bool is_whole = false;
            for (std::uint64_t at = 0; at < parts.sizes[i] && !is_whole;) {
                const std::uint64_t many =
                    tiff.read(parts.offsets[i] + at, parts.sizes[i] - at, chunk);
                const std::span<char> bytes = std::span(chunk).first(many);
                if (is_reversed) reverse_bits(bytes);
                is_whole = inflater.take(bytes, product(kMostTimes, parts.decoded));
                at += many;
            }
            if (!is_whole) throw InputError("its end is missing");
        } catch (const InputError& error) {
            throw InputError(
                "strip or tile {} of {} is damaged: {}", i + 1, parts.needed, error.what());
        }
    }
}

}  // namespace aphotic
