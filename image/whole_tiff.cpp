// SPDX-License-Identifier: BSD-3-Clause
#include "image/whole_tiff.h"

#include "base/error.h"
#include "image/decoded_size.h"
#include "image/tiff_handle.h"

#include <tiffio.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <new>
#include <span>
#include <string>
#include <vector>

namespace aphotic {
namespace {

// The first directory of a file, as libtiff reads it.
class Directory {
  public:
    explicit Directory(const std::filesystem::path& file)
        : size_(std::filesystem::file_size(file)) {
        // Not mapped, strips as stored, their places read on demand.
        tiff_ = open_tiff(file, "rmcO", said_);
        require_no_error();
    }

    // A single-valued tag, or libtiff's default.
    template <typename Value>
    [[nodiscard]] std::uint64_t number(std::uint32_t tag) const {
        Value value{};
        return ::TIFFGetFieldDefaulted(tiff_.get(), tag, &value) == 1 ? value : 0;
    }

    [[nodiscard]] std::uint64_t size() const { return size_; }
    [[nodiscard]] bool is_tiled() const { return ::TIFFIsTiled(tiff_.get()) != 0; }

    // Strips or tiles.
    [[nodiscard]] std::uint32_t parts() const {
        return is_tiled() ? ::TIFFNumberOfTiles(tiff_.get()) : ::TIFFNumberOfStrips(tiff_.get());
    }
    [[nodiscard]] std::uint64_t offset(std::uint32_t part) const {
        return ::TIFFGetStrileOffset(tiff_.get(), part);
    }
    // 0 if absent.
    [[nodiscard]] std::uint64_t bytes(std::uint32_t part) const {
        return ::TIFFGetStrileByteCount(tiff_.get(), part);
    }
    // The largest, unpacked.
    [[nodiscard]] std::uint64_t unpacked_bytes() const {
        return is_tiled() ? ::TIFFTileSize64(tiff_.get()) : ::TIFFStripSize64(tiff_.get());
    }

    void require_no_error() const {
        if (tiff_ && said_.error.empty()) return;
        const std::string why = said_.error.empty() ? "it has no directory" : said_.error;
        throw InputError("it is incomplete: {}", why);
    }
    [[nodiscard]] bool has_false_counts() const { return said_.has_false_counts; }

  private:
    std::uint64_t size_;
    SaidOfTiff said_;
    TiffHandle tiff_;
};

void require_sound_sizes(const Directory& tiff) {
    constexpr std::uint64_t kByte = 8;
    const BigSize image{tiff.number<std::uint32_t>(TIFFTAG_IMAGEWIDTH),
                        tiff.number<std::uint32_t>(TIFFTAG_IMAGELENGTH)};
    require_sides(static_cast<std::int64_t>(image.width), static_cast<std::int64_t>(image.height));
    for (const std::uint32_t tag :
         {std::uint32_t{TIFFTAG_IMAGEDEPTH}, std::uint32_t{TIFFTAG_TILEDEPTH}}) {
        const std::uint64_t depth = tiff.number<std::uint32_t>(tag);
        if (depth > 1) throw InputError("found a depth of {} pixels; allowed: 1", depth);
    }
    const std::uint64_t samples = tiff.number<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL);
    const std::uint64_t bits = tiff.number<std::uint16_t>(TIFFTAG_BITSPERSAMPLE);
    const bool is_separate =
        tiff.number<std::uint16_t>(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE;
    const std::uint64_t pixels = image.width * image.height;
    require_file_size(
        tiff.size(), product(pixels, quotient_up(samples * bits, kByte)), product(pixels, samples));
    if (!tiff.is_tiled()) return;
    require_tiles(image,
                  {tiff.number<std::uint32_t>(TIFFTAG_TILEWIDTH),
                   tiff.number<std::uint32_t>(TIFFTAG_TILELENGTH)},
                  quotient_up(is_separate ? bits : samples * bits, kByte));
}

// Frees zlib's buffers.
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

    // Whether the stream's end and checksum are within these bytes or those before them.
    bool take(std::span<std::uint8_t> bytes, std::uint64_t most_bytes) {
        stream_.next_in = bytes.data();
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
    constexpr std::uint32_t kMostParts = 1U << 23U;  // tiles of 16 x 16 of the largest image
    const Directory tiff(file);
    require_sound_sizes(tiff);
    const std::uint32_t parts = tiff.parts();
    if (parts == 0 || parts > kMostParts) {
        throw InputError("found {} strips or tiles; allowed: 1 to {}", parts, kMostParts);
    }
    for (std::uint32_t i = 0; i < parts; ++i) {
        const std::uint64_t offset = tiff.offset(i);
        const std::uint64_t bytes = tiff.bytes(i);
        tiff.require_no_error();
        if (offset == 0 || bytes == 0) {
            throw InputError("it is incomplete: strip or tile {} of {} is empty", i + 1, parts);
        }
        if (bytes <= tiff.size() && offset <= tiff.size() - bytes) continue;
        const std::uint64_t end = offset + bytes;
        if (end < offset) throw InputError("it points past its end");
        throw InputError("it is truncated: found {} bytes of at least {}", tiff.size(), end);
    }
    if (tiff.has_false_counts()) throw InputError("it is incomplete: its strip has too few bytes");
}

void require_sound_streams(const std::filesystem::path& file) {
    // The zlib streams: Adobe's deflate, its old number, and Pixar's log encoding.
    constexpr std::array<std::uint64_t, 3> kDeflated{
        COMPRESSION_ADOBE_DEFLATE, COMPRESSION_DEFLATE, COMPRESSION_PIXARLOG};
    constexpr std::uint64_t kMostTimes = 2;  // Pixar's samples have 16 bits, whatever the image's
    constexpr std::uint64_t kChunk_bytes = std::uint64_t{1} << 16U;
    const Directory tiff(file);
    if (!std::ranges::count(kDeflated, tiff.number<std::uint16_t>(TIFFTAG_COMPRESSION))) return;
    const bool is_reversed = tiff.number<std::uint16_t>(TIFFTAG_FILLORDER) == FILLORDER_LSB2MSB;
    const std::uint64_t most_bytes = product(kMostTimes, tiff.unpacked_bytes());
    std::ifstream stream(file, std::ios::binary);
    std::vector<std::uint8_t> chunk(kChunk_bytes);
    Inflater inflater;
    for (std::uint32_t i = 0; i < tiff.parts(); ++i) {
        try {
            inflater.begin();
            stream.seekg(static_cast<std::streamoff>(tiff.offset(i)));
            bool is_whole = false;
            for (std::uint64_t rest = tiff.bytes(i); rest > 0 && !is_whole;) {
                const auto bytes = std::span(chunk).first(std::min(rest, kChunk_bytes));
                stream.read(reinterpret_cast<char*>(bytes.data()), std::ssize(bytes));
                if (!stream) throw InputError("it cannot be read to the end");
                if (is_reversed) ::TIFFReverseBits(bytes.data(), std::ssize(bytes));
                is_whole = inflater.take(bytes, most_bytes);
                rest -= bytes.size();
            }
            if (!is_whole) throw InputError("its end is missing");
        } catch (const InputError& error) {
            throw InputError(
                "strip or tile {} of {} is damaged: {}", i + 1, tiff.parts(), error.what());
        }
    }
}

}  // namespace aphotic
