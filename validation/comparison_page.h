// SPDX-License-Identifier: BSD-3-Clause
//
// Two images beside each other on a page, as the source paper's figure 8 has the observed pattern
// of light and the modelled one: false colours under one scale, how they differ, and profiles
// through the middle.
//
// All is shown by square blocks of pixels, each the mean of what was observed in it, of both
// images: the sites of a mosaic and noise do not hide the pattern so. Errors are those of the
// blocks' means, over the reference's largest.
#pragma once

#include "validation/comparison.h"

#include <cstdint>
#include <string>
#include <vector>

namespace aphotic {

struct ComparedChannel {
    Comparison comparison;
    double scale = 1.0;        // the image was divided by it
    std::vector<float> image;  // rows of width_px samples
    std::vector<float> reference;
    std::vector<unsigned char> marks;  // as of compare_planes(); may be empty
};

struct ComparedImages {
    std::string image;  // their names
    std::string reference;
    int width_px = 0;
    int height_px = 0;
    bool scaled = false;
    std::vector<ComparedChannel> channels;
};

// A file by itself, well-formed as HTML and as XML.
[[nodiscard]] std::string comparison_html(const ComparedImages& images);

// False colour of a share of the scale, 0 to 1, dark blue over green to yellow: 0xRRGGBB. It gets
// lighter all the way, so it can be read without its colours.
[[nodiscard]] std::uint32_t false_colour(double share);

}  // namespace aphotic
