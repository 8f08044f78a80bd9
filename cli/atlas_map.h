// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic lightmap ATLAS -o FILE.exr: a map blended from the bins of an atlas, which needs no rig.
#pragma once

#include "cli/command.h"
#include "image/preview.h"

#include <array>
#include <optional>
#include <string>

namespace aphotic::cli {

struct AtlasMapRequest {
    std::string folder;
    std::string file;
    // What is left out is the atlas' own, where that has one value alone.
    std::optional<double> altitude_m;
    std::optional<double> pitch_deg;
    std::optional<double> roll_deg;
    std::optional<double> water_multiple;
    bool normalised = false;
    std::string preview_file;
    PreviewOptions preview;
    bool json = false;
};

// For people: the largest value of each channel.
void print_peaks(const std::array<float, kChannels>& peaks, bool is_normalised);

ExitStatus write_atlas_map(const AtlasMapRequest& request);

}  // namespace aphotic::cli
