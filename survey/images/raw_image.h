// SPDX-License-Identifier: BSD-3-Clause
//
// A camera's raw image: a mosaic of one plane, whose pixels see one channel each, the one plane of
// a mono camera, or red, green and blue planes. Samples are the camera's own numbers (0 to 4095 for
// a 12-bit camera), linear in the light; the black level is the number for no light.
#pragma once

#include "spectral/sensor.h"

#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace aphotic {

// Named after the four sites at the top left, row by row. For a mono camera all sites are alike:
// its maps, rendered or observed, have equal R, G and B.
enum class Mosaic { None, Mono, Rggb, Bggr, Grbg, Gbrg };

// Whether it has sites of three kinds.
[[nodiscard]] constexpr bool is_bayer(Mosaic mosaic) {
    return mosaic > Mosaic::Mono;
}

// "RGGB" and the like, or "mono", in any letter case.
[[nodiscard]] std::optional<Mosaic> mosaic_named(std::string_view name);
[[nodiscard]] std::string_view mosaic_name(Mosaic mosaic);

// The channel that a site of a mosaic sees: 0, 1 or 2; 0 for mono.
[[nodiscard]] int channel_at(Mosaic mosaic, int column, int row);

// The pattern left after cropping this many columns and rows at the left and top.
[[nodiscard]] Mosaic shifted(Mosaic mosaic, int columns, int rows);

struct RawImage {
    int width_px = 0;
    int height_px = 0;
    Mosaic mosaic = Mosaic::None;
    std::vector<float> samples{};  // row by row; without a mosaic R, G, B planar

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
    }
    [[nodiscard]] int planes() const { return mosaic == Mosaic::None ? kChannels : 1; }
};

// An InputError unless it has this size, "like the map"; if it is twice as wide, the message
// explains how to select one of two cameras' images.
void require_size(const RawImage& image, int width_px, int height_px, std::string_view as);

// The same, and unless it has this pattern.
void require_like(const RawImage& image, const RawImage& other, std::string_view as);

struct SensorLevels {
    float black = 0.0F;
    float white = std::numeric_limits<float>::infinity();  // saturated from here up
};

// R, G, B planar from a Bayer mosaic of at least two pixels each way. A site keeps its own sample;
// the other two channels are the mean of the nearest two or four sites, which is bilinear
// interpolation. Beyond the edge the mosaic is mirrored about its outermost pixels, so that sites
// keep their colours. A plane that is linear in column and row is reproduced, except at the edge.
[[nodiscard]] std::vector<float> demosaiced(std::span<const float> plane,
                                            int width_px,
                                            int height_px,
                                            Mosaic mosaic);

// A raw image as planes of one kind of site each, so that code for planes works on mosaics too: R,
// G and B of a colour image; the one plane of a mono camera; for a mosaic the four sites of its
// pattern, row by row, each every other pixel across and down. A mosaic of odd width or height has
// one more of the first site.

struct SitePlane {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> samples;  // row by row
};

[[nodiscard]] std::vector<SitePlane> site_planes(const RawImage& image);

// Puts the planes of site_planes() back in place.
void put_site_planes(const std::vector<SitePlane>& planes, RawImage& image);

}  // namespace aphotic
