// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic lightmap of an atlas: a map blended from its bins, which needs no rig.
#pragma once

#include "cli/command.h"
#include "cli/model_error.h"
#include "image/preview.h"
#include "lightmap/lightmap.h"

#include <array>
#include <optional>
#include <string>

namespace aphotic::cli {

struct LightmapCommandOptions {
    std::string source;  // a rig file, or the folder of an atlas
    std::string file;
    // What is left out is the rig's, or the atlas' own where that has one value alone.
    std::optional<double> altitude_m;
    std::optional<double> pitch_deg;
    std::optional<double> roll_deg;
    std::optional<double> water_multiple;
    LightmapOptions map;
    bool per_strobe = false;
    bool per_cone = false;
    bool normalised = false;
    std::string preview_file;
    PreviewOptions preview;
    bool ignore_needs = false;
    double model_tolerance = kModelTolerance;
    bool strict = false;
    bool json = false;
};

// For people: the largest value of each channel.
void print_peaks(const std::array<float, kChannels>& peaks, bool is_normalised);

ExitStatus write_atlas_map(const LightmapCommandOptions& options);

}  // namespace aphotic::cli
