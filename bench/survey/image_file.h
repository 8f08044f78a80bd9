// SPDX-License-Identifier: BSD-3-Clause
//
// Images in the formats of surveys, by OpenImageIO.
#pragma once

#include "image/output_images.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace aphotic::survey {

// One plane of 16 bits, lossless. Whole or not there.
void write_tiff(const std::filesystem::path& file,
                int width_px,
                int height_px,
                std::span<const std::uint16_t> samples);

// The first three channels of an image of any format; integers are scaled to 0..1. Throws
// InputError.
[[nodiscard]] CameraImage read_image(const std::filesystem::path& file);

}  // namespace aphotic::survey
