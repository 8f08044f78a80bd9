// SPDX-License-Identifier: BSD-3-Clause
//
// A GeoTIFF of one channel, byte by byte: uncompressed, one strip, little-endian (TIFF 6.0; OGC
// 19-008r4; GDAL's tags 42112 and 42113).
#pragma once

#include "support/tiff_writer.h"

#include <cstdint>
#include <cstring>
#include <map>
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
    TiffWriter tiff;
    for (const auto& [tag, number] :
         std::map<std::uint16_t, std::uint32_t>{{256, as.width},
                                                {257, as.height},
                                                {258, 8 * sizeof(Sample)},
                                                {259, 1},
                                                {262, 1},
                                                {277, as.channels},
                                                {278, as.height},
                                                {339, as.sample_format}})
        tiff.longs(tag, {number});
    if (!as.scale.empty()) tiff.add(33550, 12, as.scale.size(), bytes_of(as.scale));
    if (!as.tie.empty()) tiff.add(33922, 12, as.tie.size(), bytes_of(as.tie));
    std::vector<std::uint32_t> keys{1, 1, 0, static_cast<std::uint16_t>(as.keys.size() / 4)};
    keys.insert(keys.end(), as.keys.begin(), as.keys.end());
    tiff.shorts(34735, keys);
    if (!as.metadata.empty()) tiff.text(42112, as.metadata);
    if (!as.nodata.empty()) tiff.text(42113, as.nodata);
    return tiff.file(bytes_of(samples), TiffOrder::PixelsValuesDirectory);
}

}  // namespace aphotic
