// SPDX-License-Identifier: BSD-3-Clause
#include "image/exr_header.h"

#include "base/error.h"
#include "image/decoded_size.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kIsOfSeveralParts = 0x1000;
constexpr const char* kDamaged = "its header is damaged";
constexpr std::size_t kLongestName = 255;  // by the format
constexpr std::streamoff kMostHeader_bytes = std::streamoff{64} << 20U;
constexpr int kMostParts = 1000;

std::uint32_t number(std::istream& in) {
    std::array<char, 4> bytes{};
    in.read(bytes.data(), bytes.size());
    std::uint32_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) {
        value = value << 8U | static_cast<unsigned char>(bytes[i]);
    }
    return value;
}

std::string name(std::istream& in) {
    std::string text;
    for (char c = 0; in.get(c) && c != '\0' && text.size() <= kLongestName;) text += c;
    if (!in || text.size() > kLongestName) throw InputError(kDamaged);
    return text;
}

// OpenEXR reads so many bytes of these, whatever their size says.
std::optional<std::streamoff> size_of(const std::string& type) {
    constexpr std::array<std::pair<std::streamoff, std::string_view>, 13> kTypes{
        {{1, " compression deepImageState envmap lineOrder "},
         {4, " float int "},
         {8, " double rational timecode v2f v2i "},
         {9, " tiledesc "},
         {12, " v3f v3i "},
         {16, " box2f box2i v2d "},
         {24, " v3d "},
         {28, " keycode "},
         {32, " chromaticities "},
         {36, " m33f "},
         {64, " m44f "},
         {72, " m33d "},
         {128, " m44d "}}};
    for (const auto& [size, types] : kTypes) {
        if (types.find(" " + type + " ") != std::string_view::npos) return size;
    }
    return std::nullopt;
}

struct Window {
    std::int64_t left = 0;
    std::int64_t top = 0;
    std::int64_t right = -1;  // the last column, which belongs to it
    std::int64_t bottom = -1;

    bool operator==(const Window&) const = default;
    [[nodiscard]] std::int64_t width() const { return right - left + 1; }
    [[nodiscard]] std::int64_t height() const { return bottom - top + 1; }
    [[nodiscard]] std::string words() const {
        return fmt::format("{} x {} from {}, {}", width(), height(), left, top);
    }
};

// What sizes follow from.
struct Part {
    Window data{};
    Window display{};
    std::uint64_t tile_width = 0;  // 0: it has no tiles
    std::uint64_t tile_height = 0;
    std::uint64_t channels = 0;
    std::uint64_t pixel_bytes = 0;  // of all channels
    std::uint64_t chunk_rows = 1;   // compressed together
    bool is_deep = false;
};

Window window(std::istream& in) {
    const auto side = [&] { return static_cast<std::int32_t>(number(in)); };
    Window read;
    read.left = side();
    read.top = side();
    read.right = side();
    read.bottom = side();
    return read;
}

// A list that ends with an empty name, whatever its size says.
void read_channels(std::istream& in, Part& part) {
    constexpr std::uint32_t kHalf = 1;
    constexpr std::streamoff kBytesBehindTheType = 12;
    for (; !name(in).empty(); ++part.channels) {
        part.pixel_bytes += number(in) == kHalf ? 2 : 4;
        in.seekg(kBytesBehindTheType, std::ios::cur);
    }
}

// NONE, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
std::uint64_t rows_of_chunk(std::size_t compression) {
    constexpr std::array<std::uint64_t, 10> kRows{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    if (compression >= kRows.size()) throw InputError("its compression is unknown");
    return kRows[compression];
}

void read_value(std::istream& in,
                const std::string& key,
                const std::string& type,
                std::streamoff size,
                Part& part) {
    const std::streamoff end = in.tellg() + size;
    if (type == "chlist") {
        read_channels(in, part);
        if (in.tellg() != end) throw InputError(kDamaged);
    } else if (type == "box2i" && key == "dataWindow") {
        part.data = window(in);
    } else if (type == "box2i" && key == "displayWindow") {
        part.display = window(in);
    } else if (type == "tiledesc" && key == "tiles") {
        part.tile_width = number(in);
        part.tile_height = number(in);
        if (part.tile_width == 0 || part.tile_height == 0) throw InputError(kDamaged);
    } else if (type == "compression" && key == "compression") {
        part.chunk_rows = rows_of_chunk(static_cast<std::size_t>(in.get()));
    } else if (type == "string" && key == "type") {
        std::string kind(static_cast<std::size_t>(std::min(size, std::streamoff{4})), '\0');
        in.read(kind.data(), std::ssize(kind));
        part.is_deep = kind == "deep";
    }
    in.seekg(end);
}

// Up to its end; nothing at the end of all parts.
std::optional<Part> part_in(std::istream& in, std::streamoff length) {
    Part part;
    for (bool is_empty = true;; is_empty = false) {
        const std::string key = name(in);
        if (key.empty()) return is_empty ? std::nullopt : std::optional(part);
        const std::string type = name(in);
        const std::streamoff size = number(in);
        if (!in || in.tellg() + size > length) throw InputError(kDamaged);
        if (in.tellg() + size > kMostHeader_bytes) {
            throw InputError("found a header of more than {0} MiB; allowed: {0} MiB or less",
                             kMostHeader_bytes >> 20U);
        }
        if (size != size_of(type).value_or(size)) throw InputError(kDamaged);
        read_value(in, key, type, size, part);
    }
}

void require_sound(const Part& part, std::streamoff length) {
    constexpr std::uint64_t kOffset_bytes = 8;  // where a chunk stands, of each
    if (part.is_deep) throw InputError("found deep pixels; allowed: one sample a pixel");
    require_sides(part.data.width(), part.data.height());
    const auto width = static_cast<std::uint64_t>(part.data.width());
    const auto height = static_cast<std::uint64_t>(part.data.height());
    if (part.channels == 0) throw InputError(kDamaged);
    require_file_size(static_cast<std::uint64_t>(length),
                      product(width * height, part.pixel_bytes),
                      product(width * height, part.channels));
    if (part.tile_width == 0) {
        require_block(width, std::min(height, part.chunk_rows), part.pixel_bytes);
        return;
    }
    require_tiles({width, height}, {part.tile_width, part.tile_height}, part.pixel_bytes);
    const std::uint64_t tiles =
        quotient_up(width, part.tile_width) * quotient_up(height, part.tile_height);
    if (tiles * kOffset_bytes > static_cast<std::uint64_t>(length)) {
        throw InputError("it is cut short: found {} bytes for {} tiles", length, tiles);
    }
}

}  // namespace

bool is_exr(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return number(in) == kMagic && in;
}

void require_sound_exr_header(const fs::path& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    const std::streamoff length = in.tellg();
    in.seekg(0);
    if (number(in) != kMagic || !in) throw InputError("it does not begin as one");
    const bool has_parts = (number(in) & kIsOfSeveralParts) != 0;
    const std::optional<Part> first = part_in(in, length);
    if (!first) throw InputError(kDamaged);
    require_sound(*first, length);
    if (first->data != first->display) {
        throw InputError("its data window, {}, is not its display window, {}; allowed: both alike",
                         first->data.words(),
                         first->display.words());
    }
    for (int parts = 2; has_parts; ++parts) {
        const std::optional<Part> part = part_in(in, length);
        if (!part) return;
        require_sound(*part, length);
        if (parts > kMostParts) throw InputError("it has more than {} parts", kMostParts);
    }
}

}  // namespace aphotic
