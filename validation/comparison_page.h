// SPDX-License-Identifier: BSD-3-Clause
//
// Two images side by side on a page, like the observed and the modelled light in the source paper's
// figure 8: false colours on one scale, the relative error as on a validation's page, and profiles
// through the middle.
//
// Images and profiles are shown in square blocks of pixels, each the mean of its observed samples,
// so that a mosaic's sites and noise do not hide the pattern. Errors are those of the samples.
#pragma once

#include "validation/comparison.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace aphotic {

struct ComparedChannel {
    Comparison comparison;
    double scale = 1.0;        // by which the image was divided
    double black = 0.0;        // the floor of compare_planes()
    std::vector<float> image;  // rows of width_px samples
    std::vector<float> reference;
    std::vector<unsigned char> marks;  // as of compare_planes(); may be empty
};

struct ComparedImages {
    std::string image;  // their names
    std::string reference;
    int width_px = 0;
    int height_px = 0;
    double black = 0.0;  // as a share of the reference's largest sample
    bool scaled = false;
    std::vector<ComparedChannel> channels;
    // Channels of either image that were not compared: without a partner, which is a failure, or
    // those that need none.
    std::vector<std::string> only_in_image{};
    std::vector<std::string> only_in_reference{};
    std::vector<std::string> left_aside{};

    [[nodiscard]] std::size_t unpaired() const {
        return only_in_image.size() + only_in_reference.size();
    }
    // Every comparison is within its bound.
    [[nodiscard]] bool are_within() const {
        return std::ranges::all_of(
            channels, [](const ComparedChannel& channel) { return channel.comparison.holds(); });
    }
    [[nodiscard]] bool holds() const { return are_within() && unpaired() == 0; }
};

// A self-contained file, well-formed as HTML and as XML.
[[nodiscard]] std::string comparison_html(const ComparedImages& images);

// False colour of a share of the scale, 0 to 1, from dark blue over green to yellow: 0xRRGGBB. Its
// lightness increases throughout, so it can be read without colours.
[[nodiscard]] std::uint32_t false_colour(double share);

}  // namespace aphotic
