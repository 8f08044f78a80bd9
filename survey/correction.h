// SPDX-License-Identifier: BSD-3-Clause
//
// A raw image less the veil of its light, divided by its map.
//
//   corrected_c = g_c (raw - black - v_c) h / max(map_c, h least_c),
//   v_c = E_c veil_c,    E_c = middle_c / g_c,    h = min_k min(1, map_k / least_k)
//
// g      gain, one number per channel for the whole survey
// veil   what the water scatters into the view (lightmap.h); 0 where it does not scatter
// E      the camera's exposure: its numbers for a signal of 1
// map    the rig's signal at the pixel (lightmap.h), at the image's own altitude and attitude
// least  where the map is darker in any channel, the gain of all channels is reduced by one factor
//        h: noise is not amplified there, the pixel keeps its colour, and is marked as doubtful
//
// Where the map is bright enough, h = 1 and the pixel is divided by its light. No sample exceeds
// g_c (raw - black) / least_c. Only channels whose map is above 0 count in h: a map of 0 carries no
// information, as between the sites of an observed mosaic.
//
// For a floor like the rig's, raw - black = E_c (map_c + veil_c), so that corrected_c = g_c E_c at
// every pixel; twice that for a surface that reflects twice as much in a channel. The gain of a
// survey gives its median the requested value: g_c = middle_c / (the median of (raw - black) /
// (map_c + veil_c)).
//
// The veil is thus separated from the floor by the rig's floor: if the survey's median reflects r
// times as much, E is off by k = r + (1 - r) q_0, q_0 the veil's share of the signal there, and the
// corrected floor, where that share is q, by (1 - r) (q - q_0) / (k (1 - q)) of itself.
//
// Noise. A sample of s = raw - black - v has the standard deviation sqrt(r^2 + (s + v) / e): read
// noise r, and the shot noise at e electrons per number, the veil's included. Relative to s it is
// below the limit L for
//
//   s >= (q + sqrt(q^2 + 4 L^2 (r^2 + q v))) / (2 L^2),  q = 1/e, or 0 if shot noise is ignored
//
// This is r / L without shot noise, and 1 / (e L^2) without read noise or veil. v is the channel's
// largest veil in the image. The middle gives s = middle_c map_c / g_c, so that
//
//   least_c = max(share of the map's brightest, s g_c / middle_c)
#pragma once

#include "lightmap/lightmap.h"
#include "survey/images/raw_image.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace aphotic {

using PerChannel = std::array<double, kChannels>;

// Why a pixel is doubtful: bits of its mask.
inline constexpr std::uint8_t kDark = 1;       // its gain is reduced
inline constexpr std::uint8_t kSaturated = 2;  // the sample is at or above the white level
inline constexpr std::uint8_t kBlack = 4;      // it is at or below the black level, or the veil
inline constexpr std::uint8_t kEdge = 8;       // the edge of a cone is near (cone_edge.h)
inline constexpr std::uint8_t kClipped = 16;  // the corrected sample does not fit the file's format
inline constexpr std::uint8_t kRange = 32;    // its depth map has a hole there
struct DoubtWords {
    std::string_view name;
    std::uint8_t bit;
    std::string_view words;
};
inline constexpr std::array kDoubts{
    DoubtWords{"dark", kDark, "the gain is held, so that noise is not amplified"},
    DoubtWords{"saturated", kSaturated, "the camera saturates"},
    DoubtWords{"black", kBlack, "no light"},
    DoubtWords{"edge", kEdge, "the edge of a beam is near"},
    DoubtWords{"clipped", kClipped, "beyond what the file holds"},
    DoubtWords{"range", kRange, "the depth map has a hole"}};

struct NoiseLimit {
    double share = 0.01;              // of the map's brightest, in each channel
    double relative = 0.5;            // L
    double read_noise = 0.0;          // r, in the camera's numbers
    double electrons_per_number = 0;  // e; 0: shot noise is ignored
};

// The least s within the limit, next to a veil; both in the camera's numbers.
[[nodiscard]] double least_signal(const NoiseLimit& limit, double veil = 0.0);

struct Correction {
    PerChannel gain{};
    PerChannel middle{};
    SensorLevels levels;
    NoiseLimit limit;
};

struct CorrectedImage {
    RawImage image;                    // same layout as the raw one; linear, 1 is white
    std::vector<std::uint8_t> doubts;  // per pixel
};

// An InputError if raw and map differ in size, or if a sample is not finite, before or after the
// gain.
[[nodiscard]] CorrectedImage corrected(RawImage raw,
                                       const Lightmap& map,
                                       const Correction& correction);

// The same with R, G and B at every pixel, which inherits the doubts of the pixels it is made from.
[[nodiscard]] CorrectedImage demosaiced(const CorrectedImage& corrected);

// The median of (raw - black) / map_c over the pixels that are neither saturated nor black, nor
// below the share of the map's brightest. NaN if a channel has none. For a mono camera, whose map
// has equal R, G and B, all three are one.
[[nodiscard]] PerChannel middle_quotient(const RawImage& raw,
                                         const Lightmap& map,
                                         const SensorLevels& levels,
                                         double share);

}  // namespace aphotic
