// SPDX-License-Identifier: BSD-3-Clause
//
// Two images beside each other on a page, as the source paper's figure 8 has the observed pattern
// of light and the modelled one: false colours under one scale, the relative error as a
// validation's page has it, and profiles through the middle.
//
// Images and profiles are shown by square blocks of pixels, each the mean of what was observed in
// it: the sites of a mosaic and noise do not hide the pattern so. Errors are those of the samples.
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
    double scale = 1.0;        // the image was divided by it
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
    // Of the images, and not compared: without a partner, which is a no, or needing none.
    std::vector<std::string> only_in_image{};
    std::vector<std::string> only_in_reference{};
    std::vector<std::string> left_aside{};

    [[nodiscard]] std::size_t unpaired() const {
        return only_in_image.size() + only_in_reference.size();
    }
    // All that was compared is within its bound.
    [[nodiscard]] bool are_within() const {
        return std::ranges::all_of(
            channels, [](const ComparedChannel& channel) { return channel.comparison.holds(); });
    }
    [[nodiscard]] bool holds() const { return are_within() && unpaired() == 0; }
};

// A file by itself, well-formed as HTML and as XML.
[[nodiscard]] std::string comparison_html(const ComparedImages& images);

// False colour of a share of the scale, 0 to 1, dark blue over green to yellow: 0xRRGGBB. It gets
// lighter all the way, so it can be read without its colours.
[[nodiscard]] std::uint32_t false_colour(double share);

}  // namespace aphotic
