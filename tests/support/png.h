// SPDX-License-Identifier: BSD-3-Clause
//
// Pixels of a PNG file held in memory, and of one in a data URI.
#pragma once

#include <cairo.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct DecodedPng {
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> pixels;  // 0xRRGGBB, row by row
};

inline DecodedPng decode_png(std::string_view png) {
    const auto read = [](void* from, unsigned char* to, unsigned int count) {
        auto* rest = static_cast<std::string_view*>(from);
        if (rest->size() < count) return CAIRO_STATUS_READ_ERROR;
        std::copy_n(rest->begin(), count, to);
        rest->remove_prefix(count);
        return CAIRO_STATUS_SUCCESS;
    };
    cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(read, &png);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
        cairo_surface_destroy(surface);
        throw std::runtime_error("not a PNG file");
    }
    DecodedPng picture{.width = cairo_image_surface_get_width(surface),
                       .height = cairo_image_surface_get_height(surface),
                       .pixels = {}};
    const unsigned char* data = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int row = 0; row < picture.height; ++row) {
        const auto* pixels = reinterpret_cast<const std::uint32_t*>(
            data + static_cast<std::ptrdiff_t>(row) * stride);
        for (int column = 0; column < picture.width; ++column)
            picture.pixels.push_back(pixels[column] & 0xFFFFFFU);
    }
    cairo_surface_destroy(surface);
    return picture;
}

inline std::string decode_base64(std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int held = 0;
    for (const char digit : text.substr(0, text.find('='))) {
        const std::size_t value = kDigits.find(digit);
        if (value == std::string_view::npos) throw std::runtime_error("not base64");
        bits = (bits << 6U | static_cast<unsigned>(value)) & 0xFFFFU;
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 0xFFU);
    }
    return bytes;
}

}  // namespace aphotic
