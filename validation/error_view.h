// SPDX-License-Identifier: BSD-3-Clause
//
// The relative errors (comparison.h) on a page: the formula, the map of one channel with the worst
// pixel ringed and a colour key, and profiles along a line of pixels.
#pragma once

#include "report/page.h"
#include "validation/comparison.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

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
