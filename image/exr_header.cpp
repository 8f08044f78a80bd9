// SPDX-License-Identifier: BSD-3-Clause
#include "image/exr_header.h"

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

// A list that ends with an empty name, whatever its size says.
void pass_over_channels(std::istream& in) {
    constexpr std::streamoff kBytesOfAChannel = 16;
    while (!name(in).empty()) in.seekg(kBytesOfAChannel, std::ios::cur);
}

}  // namespace

void require_sound_exr_header(const std::filesystem::path& file) {
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

}  // namespace aphotic
