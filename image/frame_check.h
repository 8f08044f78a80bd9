// SPDX-License-Identifier: BSD-3-Clause
//
// Checks that a frame is what was requested: size, channels R, G and B, every sample finite, not
// negative and below the largest half float; POV-Ray's EXR has inf for brighter light. A RunError
// names the frame and the pixel.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace aphotic {

inline constexpr float kLargestHalf = 65504.0F;
inline constexpr int kSmallestNormalHalfLog2 = -14;  // half floats lose digits below it

// Samples of whole rows that start at first_row.
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

// Reads the whole file once.
void check_frame(const std::filesystem::path& file, int width_px, int height_px);

}  // namespace aphotic
