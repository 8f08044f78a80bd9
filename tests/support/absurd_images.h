// SPDX-License-Identifier: BSD-3-Clause
//
// Files whose headers cost nothing and ask for gigabytes, written by hand after each format's
// specification: PNG (ISO/IEC 15948), JPEG (ITU T.81), TIFF 6.0 and OpenEXR.
#pragma once

#include "support/tiff_writer.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace aphotic {

// With its length, its four letters and its CRC-32.
inline std::string png_chunk(const std::string& letters, const std::string& contents) {
    constexpr std::uint32_t kPolynomial = 0xEDB88320U;
    std::uint32_t crc = ~0U;
    for (const char c : letters + contents) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? kPolynomial : 0U);
    }
    std::string chunk;
    put_big(chunk, contents.size(), 4);
    chunk += letters + contents;
    put_big(chunk, ~crc, 4);
    return chunk;
}

// 16 bits, one channel, and pixels that are none.
inline std::string png_of_size(std::uint32_t width, std::uint32_t height) {
    std::string header;
    put_big(header, width, 4);
    put_big(header, height, 4);
    header += std::string("\x10\0\0\0\0", 5);
    return "\x89PNG\r\n\x1A\n" + png_chunk("IHDR", header) +
           png_chunk("IDAT", std::string("\x78\x9C\x63", 3)) + png_chunk("IEND", "");
}

// One component, Huffman codes of one bit, and the first few of its blocks.
inline std::string jpeg_of_size(std::uint32_t width, std::uint32_t height) {
    std::string bytes("\xFF\xD8\xFF\xDB\0\x43\0", 7);
    bytes += std::string(64, '\1');
    bytes += std::string("\xFF\xC0\0\x0B\x08", 5);
    put_big(bytes, height, 2);
    put_big(bytes, width, 2);
    bytes += std::string("\1\1\x11\0", 4);
    for (const char table : {'\0', '\x10'}) {
        bytes += std::string("\xFF\xC4\0\x14", 4) + table + '\1' + std::string(15, '\0') + '\0';
    }
    return bytes + std::string("\xFF\xDA\0\x08\1\1\0\0\x3F\0", 10) + std::string(16, '\0') +
           "\xFF\xD9";
}

// Little-endian, of numbers of 32 bits but for what TIFF wants to be of 16; one strip or tile of
// the bytes, deflated by name.
inline std::string tiff_of_tags(std::map<std::uint16_t, std::uint32_t> tags,
                                const std::string& pixels) {
    tags.insert({{258, 16}, {259, 8}, {262, 1}, {277, 1}});
    TiffWriter tiff;
    for (const auto& [tag, value] : tags) {
        if (tag == 258 || tag == 259 || tag == 262 || tag == 277) {
            tiff.shorts(tag, {value});
        } else {
            tiff.longs(tag, {value});
        }
    }
    return tiff.file(pixels, TiffOrder::DirectoryValuesPixels);
}

struct ExrSides {
    std::int32_t left = 0;
    std::int32_t top = 0;
    std::int32_t width = 0;
    std::int32_t height = 0;
};

// Floats R, G and B, ZIP, and nothing behind the header; tiles of that side, or none.
inline std::string exr_of_windows(ExrSides data, ExrSides display, std::uint32_t tile = 0) {
    std::string bytes;
    put_little(bytes, 20000630, 4);
    put_little(bytes, tile == 0 ? 2 : 2 | 0x200, 4);
    const auto attribute =
        [&](const std::string& name, const std::string& type, const std::string& value) {
            bytes += name + '\0' + type + '\0';
            put_little(bytes, value.size(), 4);
            bytes += value;
        };
    const auto numbers = [](const std::vector<std::int32_t>& values) {
        std::string text;
        for (const std::int32_t value : values)
            put_little(text, static_cast<std::uint32_t>(value), 4);
        return text;
    };
    const auto window = [&](const ExrSides& sides) {
        return numbers(
            {sides.left, sides.top, sides.left + sides.width - 1, sides.top + sides.height - 1});
    };
    std::string channels;
    for (const char name : {'B', 'G', 'R'}) {
        channels += std::string(1, name) + '\0' + numbers({2, 0, 1, 1});
    }
    attribute("channels", "chlist", channels + '\0');
    attribute("compression", "compression", "\3");
    attribute("dataWindow", "box2i", window(data));
    attribute("displayWindow", "box2i", window(display));
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", numbers({0x3F800000}));
    attribute("screenWindowCenter", "v2f", numbers({0, 0}));
    attribute("screenWindowWidth", "float", numbers({0x3F800000}));
    const auto side = static_cast<std::int32_t>(tile);
    if (tile != 0) attribute("tiles", "tiledesc", numbers({side, side}) + '\0');
    return bytes + '\0';
}

// By their names in a folder, which differ without their endings, too. Those that begin with "own"
// say that they have these pixels.
inline std::map<std::string, std::string> absurd_images(std::uint32_t width, std::uint32_t height) {
    const auto w = static_cast<std::int32_t>(width);
    const auto h = static_cast<std::int32_t>(height);
    const ExrSides own{0, 0, w, h};
    const ExrSides large{0, 0, 30000, 30000};
    const ExrSides absurd{-2000000000, 0, 2000000000, 2000000000};
    return {{"png-wide.png", png_of_size(200000, 200000)},
            {"png-large.png", png_of_size(20000, 20000)},
            {"jpeg-large.jpg", jpeg_of_size(65500, 65500)},
            {"tiff-large.tif", tiff_of_tags({{256, 16000}, {257, 16000}, {278, 16000}}, "xx")},
            {"tiff-absurd.tif",
             tiff_of_tags({{256, 4000000000U}, {257, 4000000000U}, {278, 4000000000U}}, "xx")},
            {"own-tiles.tif",
             tiff_of_tags({{256, width}, {257, height}, {322, 1U << 20U}, {323, 1U << 20U}}, "xx")},
            {"own-samples.tif",
             tiff_of_tags({{256, width}, {257, height}, {278, height}, {277, 65535}}, "xx")},
            {"own-depth.tif",
             tiff_of_tags({{256, width}, {257, height}, {278, height}, {32997, 100000}}, "xx")},
            {"exr-large.exr", exr_of_windows(large, large)},
            {"exr-absurd.exr", exr_of_windows(absurd, absurd)},
            {"own-tiles-of-exr.exr", exr_of_windows(own, own, 1U << 15U)},
            {"own-window-of-exr.exr", exr_of_windows({0, 0, w, h - 1}, own)}};
}

}  // namespace aphotic
