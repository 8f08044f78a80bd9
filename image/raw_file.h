// SPDX-License-Identifier: BSD-3-Clause
//
// Cameras' raw files: DNG, CR2, NEF, ARW and others that LibRaw reads, as the sensor wrote them,
// without the masked border. Nothing is interpolated, balanced or scaled.
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
    // Number for no light. If sites differ, samples are shifted to the lowest.
    double black = 0.0;
    double white = 0.0;  // at saturation, for the site that saturates first
    // Row by row, or planes R, G and B for "none", in the sensor's own numbers. An InputError if
    // the file is damaged.
    std::function<std::vector<float>()> samples;
};

// By its extension, ignoring case.
[[nodiscard]] bool is_raw_name(const std::filesystem::path& file);

// An InputError, "FILE: cannot be read: why", when it is none of these.
[[nodiscard]] RawFile open_raw_file(const std::filesystem::path& file);

}  // namespace aphotic
