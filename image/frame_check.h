// SPDX-License-Identifier: BSD-3-Clause
//
// Is a frame what was asked for? Size, channels R, G and B, every sample finite, not negative
// and below the largest half float; of brighter light POV-Ray's EXR holds inf. What is wrong is
// a RunError that names the frame and the pixel.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace aphotic {

inline constexpr float kLargestHalf = 65504.0F;
inline constexpr int kSmallestNormalHalfLog2 = -14;  // below it half floats lose digits

// Samples of whole rows, the first of which is first_row.
void check_samples(const std::filesystem::path& file,
                   const std::string& channel,
                   std::span<const float> samples,
                   int width_px,
                   int first_row);

void check_size(const std::filesystem::path& file,
                int found_width_px,
                int found_height_px,
                int width_px,
                int height_px);

// All of it, reading the file through once.
void check_frame(const std::filesystem::path& file, int width_px, int height_px);

}  // namespace aphotic
