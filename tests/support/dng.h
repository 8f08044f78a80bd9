// SPDX-License-Identifier: BSD-3-Clause
//
// A raw file as small as Adobe's specification lets it be (Digital Negative 1.4): TIFF,
// little-endian, one uncompressed strip of 16 bits.
#pragma once

#include "support/tiff_writer.h"

#include <cstdint>
#include <string>
#include <vector>

namespace aphotic {

struct Dng {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint16_t> samples{};           // row by row; of colours side by side
    std::vector<std::uint8_t> pattern{0, 1, 1, 2};  // red 0, green 1, blue 2; none: not a mosaic
    std::uint16_t colours = 1;                      // of a pixel
    std::vector<std::uint32_t> black{};             // one, or four of two by two sites
    std::uint32_t white = 0;                        // 0: not told
    std::vector<std::uint32_t> active_area{};       // top, left, bottom, right
    std::uint32_t exposure_ms = 0;                  // 0: not told
    std::uint16_t iso = 0;
};

inline std::string dng_of(const Dng& dng) {
    TiffWriter tiff;
    const auto raw = [&](std::uint16_t tag, const std::vector<std::uint8_t>& bytes) {
        tiff.add(tag, 1, bytes.size(), std::string(bytes.begin(), bytes.end()));
    };
    std::string pixels;
    for (const std::uint16_t sample : dng.samples) put_little(pixels, sample, 2);
    const bool is_mosaic = !dng.pattern.empty();
    tiff.longs(254, {0});
    tiff.longs(256, {dng.width});
    tiff.longs(257, {dng.height});
    tiff.shorts(258, std::vector<std::uint32_t>(dng.colours, 16));
    tiff.shorts(259, {1});
    tiff.shorts(262, {is_mosaic ? 32803U : 34892U});
    tiff.text(271, "Acme");
    tiff.text(272, "Deep 1");
    tiff.shorts(274, {1});
    tiff.shorts(277, {dng.colours});
    tiff.longs(278, {dng.height});
    tiff.shorts(284, {1});
    if (is_mosaic) {
        tiff.shorts(33421, {2, 2});
        raw(33422, dng.pattern);
    }
    if (dng.exposure_ms > 0) tiff.rationals(33434, 5, {dng.exposure_ms, 1000});
    if (dng.iso > 0) tiff.shorts(34855, {dng.iso});
    raw(50706, {1, 4, 0, 0});
    raw(50707, {1, 1, 0, 0});
    tiff.text(50708, "Acme Deep 1");
    if (is_mosaic) {
        raw(50710, {0, 1, 2});
        tiff.shorts(50711, {1});
    }
    if (dng.black.size() > 1) tiff.shorts(50713, {2, 2});
    if (!dng.black.empty()) tiff.longs(50714, dng.black);
    if (dng.white > 0) tiff.longs(50717, std::vector<std::uint32_t>(dng.colours, dng.white));
    tiff.rationals(50721, 10, {1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1});
    tiff.rationals(50728, 5, {1, 1, 1, 1, 1, 1});
    tiff.shorts(50778, {21});
    if (!dng.active_area.empty()) tiff.longs(50829, dng.active_area);
    return tiff.file(pixels, TiffOrder::DirectoryValuesPixels);
}

}  // namespace aphotic
