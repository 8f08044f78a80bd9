// SPDX-License-Identifier: BSD-3-Clause
//
// A picture for viewing: the camera's signal, white-balanced, exposed and encoded as sRGB PNG.
//
//   shown_c = sRGB( 2^stops * gain * S_c / W_c )
//
// S_c    signal of channel c
// W_c    the white: the lamp's own signal, or 1 (none), or the image's mean
// gain   scales the image's kBrightShare quantile, over all channels, to kBrightLevel
// sRGB   encoding of IEC 61966-2-1: 12.92 x up to 0.0031308, else 1.055 x^(1/2.4) - 0.055;
//        clipped to 0..1, then rounded to 8 bits
//
// For viewing, not for measuring: camera channels are shown as if they were sRGB's own primaries. A
// white surface in clear water is shown grey. A black image remains black.
#pragma once

#include "image/camera_image.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace aphotic {

inline constexpr double kBrightShare = 0.995;
inline constexpr double kBrightLevel = 0.9;

enum class PreviewWhite { Lamp, Image, None };

struct PreviewOptions {
    PreviewWhite white = PreviewWhite::Lamp;
    double stops = 0.0;  // brighter by 2^stops
};

// sRGB's transfer function, from linear 0..1 to encoded 0..1; clips outside.
[[nodiscard]] double srgb_encoded(double linear);

// The factor for each channel's samples before encoding: 2^stops gain / W_c. Samples that are not
// finite are ignored. lamp_signal: Manifest::lamp_signal.
[[nodiscard]] std::array<double, kChannels> preview_scale(
    const CameraImage& image,
    const std::array<double, kChannels>& lamp_signal,
    const PreviewOptions& options);

// The picture under a given scale, as the bytes of a PNG file: images under one scale can be
// compared by eye. NaN is shown black.
[[nodiscard]] std::string preview_png(const CameraImage& image,
                                      const std::array<double, kChannels>& scale);

// Pixels 0xRRGGBB, row by row, as the bytes of a PNG file.
[[nodiscard]] std::string png_of(std::span<const std::uint32_t> pixels,
                                 int width_px,
                                 int height_px);

void write_preview(const CameraImage& image,
                   const std::array<double, kChannels>& lamp_signal,
                   const PreviewOptions& options,
                   const std::filesystem::path& file);

}  // namespace aphotic
