// SPDX-License-Identifier: BSD-3-Clause
#include "image/exr_header.h"

#include "base/error.h"
#include "image/decoded_size.h"

#include <openexr.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr const char* kDamaged = "its header is damaged";

// An upper limit for headers; no attribute is as long.
void* moderate_memory(std::size_t bytes) {
    constexpr std::size_t kMost_bytes = std::size_t{64} << 20U;
    return bytes <= kMost_bytes ? std::malloc(bytes) : nullptr;
}

void require(exr_result_t result) {
    if (result == EXR_ERR_SUCCESS) return;
    throw InputError("{}: {}", kDamaged, exr_get_default_error_message(result));
}

// Reads a file's headers and prints nothing.
class Headers {
  public:
    explicit Headers(const fs::path& file) {
        exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
        how.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
        how.alloc_fn = moderate_memory;
        how.free_fn = std::free;
        how.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
        require(exr_start_read(&context_, file.c_str(), &how));
    }
    ~Headers() { exr_finish(&context_); }
    Headers(const Headers&) = delete;
    Headers& operator=(const Headers&) = delete;

    template <typename Value, typename Get>
    [[nodiscard]] Value of(int part, Get get) const {
        Value value{};
        require(get(context_, part, &value));
        return value;
    }

    [[nodiscard]] int parts() const {
        int parts = 0;
        require(exr_get_count(context_, &parts));
        return parts;
    }

    [[nodiscard]] BigSize tile(int part) const {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        require(exr_get_tile_descriptor(context_, part, &width, &height, nullptr, nullptr));
        return {width, height};
    }

    [[nodiscard]] const exr_attribute_t& attribute(int part, int index) const {
        const exr_attribute_t* found = nullptr;
        require(
            exr_get_attribute_by_index(context_, part, EXR_ATTR_LIST_FILE_ORDER, index, &found));
        return *found;
    }

  private:
    exr_context_t context_ = nullptr;
};

std::int64_t width_of(const exr_attr_box2i_t& window) {
    return std::int64_t{window.max.x} - window.min.x + 1;
}

std::int64_t height_of(const exr_attr_box2i_t& window) {
    return std::int64_t{window.max.y} - window.min.y + 1;
}

std::string words_of(const exr_attr_box2i_t& window) {
    return fmt::format(
        "{} x {} from {}, {}", width_of(window), height_of(window), window.min.x, window.min.y);
}

// OpenEXR's image reader takes one byte for this type whatever its declared size, but its header
// reader does not support the type, and would read the following data from the wrong place.
void require_sizes_of_types(const Headers& headers, int part) {
    const auto count = headers.of<std::int32_t>(part, exr_get_attribute_count);
    for (int i = 0; i < count; ++i) {
        const exr_attribute_t& attribute = headers.attribute(part, i);
        if (std::string_view(attribute.type_name) != "deepImageState") continue;
        if (attribute.type != EXR_ATTR_OPAQUE || attribute.opaque->size != 1)
            throw InputError(kDamaged);
    }
}

void require_sound(const Headers& headers, int part, std::uint64_t length) {
    constexpr std::uint64_t kOffset_bytes = 8;  // the offset of each chunk
    const auto storage = headers.of<exr_storage_t>(part, exr_get_storage);
    if (storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED)
        throw InputError("found deep pixels; allowed: one sample per pixel");
    require_sizes_of_types(headers, part);
    const auto window = headers.of<exr_attr_box2i_t>(part, exr_get_data_window);
    require_sides(width_of(window), height_of(window));
    const BigSize image{static_cast<std::uint64_t>(width_of(window)),
                        static_cast<std::uint64_t>(height_of(window))};
    const auto* channels = headers.of<const exr_attr_chlist_t*>(part, exr_get_channels);
    std::uint64_t pixel_bytes = 0;
    for (int i = 0; i < channels->num_channels; ++i)
        pixel_bytes += channels->entries[i].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    if (pixel_bytes == 0) throw InputError(kDamaged);
    const std::uint64_t pixels = image.width * image.height;
    require_file_size(length,
                      product(pixels, pixel_bytes),
                      product(pixels, static_cast<std::uint64_t>(channels->num_channels)));
    if (storage == EXR_STORAGE_TILED) {
        require_tiles(image, headers.tile(part), pixel_bytes);
    } else {
        const auto rows = headers.of<std::int32_t>(part, exr_get_scanlines_per_chunk);
        require_block(
            image.width, std::min(image.height, static_cast<std::uint64_t>(rows)), pixel_bytes);
    }
    const auto chunks = headers.of<std::int32_t>(part, exr_get_chunk_count);
    if (static_cast<std::uint64_t>(chunks) * kOffset_bytes > length)
        throw InputError("it is truncated: found {} bytes for {} chunks", length, chunks);
}

}  // namespace

bool is_exr(const fs::path& file) {
    constexpr std::string_view kMagic = "\x76\x2f\x31\x01";
    std::array<char, kMagic.size()> first{};
    std::ifstream in(file, std::ios::binary);
    return in.read(first.data(), first.size()) && std::ranges::equal(first, kMagic);
}

void require_sound_exr_header(const fs::path& file) {
    constexpr int kMostParts = 1000;
    if (!is_exr(file)) throw InputError("it does not start with an OpenEXR magic number");
    const Headers headers(file);
    if (headers.parts() > kMostParts) throw InputError("it has more than {} parts", kMostParts);
    for (int part = 0; part < headers.parts(); ++part)
        require_sound(headers, part, fs::file_size(file));
    const auto data = headers.of<exr_attr_box2i_t>(0, exr_get_data_window);
    const auto display = headers.of<exr_attr_box2i_t>(0, exr_get_display_window);
    if (std::memcmp(&data, &display, sizeof data) == 0) return;
    throw InputError("its data window, {}, differs from its display window, {}; allowed: equal",
                     words_of(data),
                     words_of(display));
}

}  // namespace aphotic
