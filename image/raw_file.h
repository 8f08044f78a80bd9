// SPDX-License-Identifier: BSD-3-Clause
//
// The raw files of cameras: DNG, CR2, NEF, ARW and what else LibRaw reads, as the sensor wrote
// them, without its rim of covered pixels. Nothing is interpolated, balanced or scaled.
//
// OpenImageIO 2.4 reads them, too, but calls the pattern of an RGGB sensor GMCY and tells no
// levels. LibRaw tells both: from the file, or from its table of cameras.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aphotic {

struct RawFile {
    int width_px = 0;
    int height_px = 0;
    // "RGGB" and its kin, "mono", or "none": R, G and B at every pixel, as in a linear DNG.
    std::string pattern;
    // Number for no light. Where sites have different ones, samples are moved to the least of them.
    double black = 0.0;
    double white = 0.0;  // at saturation, of the site that gets there first
    // Row by row, of "none" planes R, G and B, in the sensor's own numbers. An InputError when the
    // file is damaged.
    std::function<std::vector<float>()> samples;
};

// By its extension, in any letter case.
[[nodiscard]] bool is_raw_name(const std::filesystem::path& file);

// An InputError, "FILE: cannot be read: why", when it is none of these.
[[nodiscard]] RawFile open_raw_file(const std::filesystem::path& file);

}  // namespace aphotic
