// SPDX-License-Identifier: BSD-3-Clause
#include "image/exr_header.h"

#include <openexr.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace aphotic {

namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kIsOfSeveralParts = 0x1000;
constexpr const char* kDamaged = "its header is damaged";
constexpr std::size_t kLongestName = 255;  // by the format

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
    if (!in || text.size() > kLongestName) throw std::runtime_error(kDamaged);
    return text;
}

// The C++ library reads so many bytes of these, whatever their size says.
std::optional<std::streamoff> size_of(std::string_view type) {
    constexpr std::array<std::pair<std::string_view, std::streamoff>, 24> kSizes{
        {{"box2i", 16},
         {"box2f", 16},
         {"chromaticities", 32},
         {"compression", 1},
         {"deepImageState", 1},
         {"double", 8},
         {"envmap", 1},
         {"float", 4},
         {"int", 4},
         {"keycode", 28},
         {"lineOrder", 1},
         {"m33d", 72},
         {"m33f", 36},
         {"m44d", 128},
         {"m44f", 64},
         {"rational", 8},
         {"tiledesc", 9},
         {"timecode", 8},
         {"v2d", 16},
         {"v2f", 8},
         {"v2i", 8},
         {"v3d", 24},
         {"v3f", 12},
         {"v3i", 12}}};
    for (const auto& [name, size] : kSizes) {
        if (name == type) return size;
    }
    return std::nullopt;
}

// A list that ends with an empty name, whatever its size: the C++ library reads it so.
void pass_over_channels(std::istream& in) {
    constexpr std::streamoff kBytesOfAChannel = 16;
    while (!name(in).empty()) in.seekg(kBytesOfAChannel, std::ios::cur);
}

// Each attribute is there as long as it says.
void require_lengths(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    const std::streamoff length = in.tellg();
    in.seekg(0);
    if (number(in) != kMagic || !in) throw std::runtime_error("it does not begin as one");
    const bool has_parts = (number(in) & kIsOfSeveralParts) != 0;
    for (bool at_start = true;;) {
        if (name(in).empty()) {
            if (at_start || !has_parts) return;
            at_start = true;
            continue;
        }
        at_start = false;
        const std::string type = name(in);
        const std::streamoff size = number(in);
        const std::streamoff end = in.tellg() + size;
        if (!in || end > length) throw std::runtime_error(kDamaged);
        if (size != size_of(type).value_or(size)) throw std::runtime_error(kDamaged);
        if (type == "chlist") pass_over_channels(in);
        if (type == "chlist" && in.tellg() != end) throw std::runtime_error(kDamaged);
        in.seekg(end);
    }
}

// Each attribute says the length that its type has: OpenEXR's C library looks, the C++ one does
// not.
void require_types(const std::filesystem::path& file) {
    exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
    options.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
    exr_context_t context = nullptr;
    const exr_result_t result = exr_start_read(&context, file.c_str(), &options);
    exr_finish(&context);
    if (result != EXR_ERR_SUCCESS) throw std::runtime_error(exr_get_default_error_message(result));
}

}  // namespace

void require_sound_exr_header(const std::filesystem::path& file) {
    require_lengths(file);
    require_types(file);
}

}  // namespace aphotic
