// SPDX-License-Identifier: BSD-3-Clause
//
// The relative errors (comparison.h) on a page: the formula, the map of one channel with the worst
// pixel ringed and a colour key, and profiles along a line of pixels.
//
// A large image is shown in square blocks of pixels, small enough to embed in a page: for a
// camera's image each block's mean, for an error map each block's largest |e|, with its sign, so
// that no error is averaged away.
//
//   colour(e) = blue for -scale .. white for 0 .. red for +scale, in kColourSteps steps
//
// Errors beyond the scale have the colour of its end. A block is grey if all its samples are on
// edges, black if any of its samples is not finite.
#pragma once

#include "image/output_images.h"
#include "report/page.h"
#include "validation/comparison.h"

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

// The formula, with the meanings of a, b and b0.
[[nodiscard]] std::vector<PagePart> error_rule(std::string a, std::string b, std::string black);

struct MappedErrors {
    const Comparison* comparison = nullptr;
    // Rows of width_px samples; NaN for samples that were not compared or are not finite in one of
    // the images.
    std::span<const float> errors{};
    std::span<const float> image{};
    std::span<const float> reference{};
    int width_px = 0;
    int least_side = 1;        // of the blocks of pixels shown as one
    std::string image_name{};  // "POV-Ray"
    std::string set_apart{};   // the key of grey: "on edges: 12 pixels"; empty: no grey
};

struct ErrorMap {
    int side = 1;  // of a block
    int width_px = 0;
    int height_px = 0;
    std::string png{};
};
[[nodiscard]] ErrorMap error_map(const MappedErrors& mapped, double scale);

// The map, its legend and a paragraph. The colours extend to the 99.9 percentile, rounded up, so
// that details are visible besides the largest error.
[[nodiscard]] std::vector<PagePart> error_map_parts(const MappedErrors& mapped);

// A channel along the middle row or column of both images.
struct Profile {
    std::string channel;
    std::vector<double> position_px{};  // of the samples' centres
    std::vector<double> image{};
    std::vector<double> reference{};
    std::vector<double> errors{};  // NaN: not compared; empty: not shown
    double bound = 0.0;            // on the errors
};

// All channels, one below the other. pixels: the number along the line. id: that of the drawing.
[[nodiscard]] PagePlot profile_plot(std::string_view id,
                                    bool is_row,
                                    int pixels,
                                    std::span<const Profile> profiles);

}  // namespace aphotic
