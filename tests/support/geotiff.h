// SPDX-License-Identifier: BSD-3-Clause
//
// A GeoTIFF of one channel, byte by byte: uncompressed, one strip, little-endian (TIFF 6.0; OGC
// 19-008r4; GDAL's tags 42112 and 42113).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace aphotic {

struct GeoTiffText {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint16_t sample_format = 3;  // 1: unsigned, 2: signed, 3: floats
    std::uint16_t channels = 1;
    std::vector<double> scale{1.0, 1.0, 0.0};  // empty: without
    std::vector<double> tie{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    // Key, 0, 1, value each: of a projection, samples for their cells, metres.
    std::vector<std::uint16_t> keys{1024, 0, 1, 1, 1025, 0, 1, 1, 3076, 0, 1, 9001};
    std::string nodata{};
    std::string metadata{};
};

template <typename Sample>
std::string bytes_of(const std::vector<Sample>& values) {
    std::string bytes(values.size() * sizeof(Sample), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

template <typename Sample>
std::string geotiff_of(const std::vector<Sample>& samples, const GeoTiffText& as) {
    constexpr std::size_t kHead = 8;
    const auto put = [](std::string& bytes, std::uint32_t number, int size) {
        for (int i = 0; i < size; ++i)
            bytes += static_cast<char>(number >> static_cast<unsigned>(8 * i) & 0xFFU);
    };
    std::string file("II*\0\0\0\0\0", kHead);
    file += bytes_of(samples);
    const auto pixel_bytes = static_cast<std::uint32_t>(file.size() - kHead);
    std::string directory;
    std::uint32_t entries = 0;
    const auto add =
        [&](std::uint32_t tag, std::uint32_t type, std::size_t count, std::string value) {
            if (count == 0) return;
            ++entries;
            put(directory, tag, 2);
            put(directory, type, 2);
            put(directory, static_cast<std::uint32_t>(count), 4);
            if (value.size() > 4) {
                file.append(file.size() % 2, '\0');
                const auto at = static_cast<std::uint32_t>(file.size());
                file += value;
                value.clear();
                put(value, at, 4);
            }
            value.resize(4, '\0');
            directory += value;
        };
    const auto number = [&](std::uint32_t tag, std::uint32_t value) {
        std::string bytes;
        put(bytes, value, 4);
        add(tag, 4, 1, bytes);
    };
    const auto text = [&](std::uint32_t tag, const std::string& words) {
        add(tag, 2, words.empty() ? 0 : words.size() + 1, words + std::string(1, '\0'));
    };
    number(256, as.width);
    number(257, as.height);
    number(258, 8 * sizeof(Sample));
    number(259, 1);
    number(262, 1);
    number(273, kHead);
    number(277, as.channels);
    number(278, as.height);
    number(279, pixel_bytes);
    number(339, as.sample_format);
    add(33550, 12, as.scale.size(), bytes_of(as.scale));
    add(33922, 12, as.tie.size(), bytes_of(as.tie));
    std::vector<std::uint16_t> keys{1, 1, 0, static_cast<std::uint16_t>(as.keys.size() / 4)};
    keys.insert(keys.end(), as.keys.begin(), as.keys.end());
    add(34735, 3, keys.size(), bytes_of(keys));
    text(42112, as.metadata);
    text(42113, as.nodata);
    file.append(file.size() % 2, '\0');
    std::string at;
    put(at, static_cast<std::uint32_t>(file.size()), 4);
    file.replace(4, 4, at);
    put(file, entries, 2);
    return file + directory + std::string(4, '\0');
}

}  // namespace aphotic
