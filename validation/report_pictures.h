// SPDX-License-Identifier: BSD-3-Clause
//
// The pictures of a report, small enough to embed in its page.
//
// A large image is shown in square blocks of pixels: for a camera's image each block's mean, for an
// error map each block's largest |e|, with its sign, so that no error is averaged away.
//
//   colour(e) = blue for -scale .. white for 0 .. red for +scale, in kColourSteps steps
//
// Errors beyond the scale have the colour of its end. A block is grey if all its samples are on
// edges, black if any of its samples is not finite.
#pragma once

#include "image/output_images.h"
#include "report/picture.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

inline constexpr int kLargestPicture_px = 1000;  // across and down
inline constexpr int kColourSteps = 65;          // odd: the middle one is white
inline constexpr std::uint32_t kEdgeColour = 0xA3A19B;
inline constexpr std::uint32_t kNotFiniteColour = 0x000000;

// The side of the blocks, so that the picture is at most kLargestPicture_px across and down.
[[nodiscard]] int block_side(int width_px, int height_px);

[[nodiscard]] CameraImage block_means(const CameraImage& image, int side);

// The same for one channel, ignoring samples marked as unobserved (comparison.h): NaN for blocks
// without other samples. marks may be empty.
[[nodiscard]] std::vector<double> block_means(std::span<const float> samples,
                                              int width_px,
                                              int side,
                                              std::span<const unsigned char> marks = {});

// The colour at a share of the way along the stops, 0 at the first and 1 at the last; 0xRRGGBB.
[[nodiscard]] std::uint32_t colour_between(std::span<const std::uint32_t> stops, double share);

// step from -(kColourSteps - 1) / 2 to (kColourSteps - 1) / 2; 0xRRGGBB.
[[nodiscard]] std::uint32_t error_colour(int step);

struct ErrorMap {
    int side = 1;  // of a block
    int width_px = 0;
    int height_px = 0;
    std::string png{};
};

// errors: one channel's, rows of width_px samples, NaN on edges and where samples are not finite;
// `a` and `b`, from which they were computed, distinguish these two. least_side: that of the
// blocks.
[[nodiscard]] ErrorMap error_map(std::span<const float> errors,
                                 std::span<const float> a,
                                 std::span<const float> b,
                                 int width_px,
                                 double scale,
                                 int least_side = 1);

}  // namespace aphotic
