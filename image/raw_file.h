// SPDX-License-Identifier: BSD-3-Clause
//
// Cameras' raw files: DNG, CR2, NEF, ARW and others that LibRaw supports, with the sensor's own
// samples, without the masked border. There is no interpolation, white balance or scaling.
//
// OpenImageIO 2.4 also reads them, but reports the pattern of an RGGB sensor as GMCY, and no
// levels. LibRaw reports both, from the file or from its table of cameras.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aphotic {

struct RawFile {
    int width_px = 0;
    int height_px = 0;
    // "RGGB" or similar, "mono", or "none": R, G and B at every pixel, as in a linear DNG.
    std::string pattern;
    // The number without light. If sites differ, samples are shifted to the lowest.
    double black = 0.0;
    double white = 0.0;  // at saturation, for the site that saturates first
    // Row by row, or planes R, G and B for "none", in the sensor's own numbers. An InputError if
    // the file is damaged.
    std::function<std::vector<float>()> samples;
};

// Whether the extension is a raw file's, ignoring case.
[[nodiscard]] bool is_raw_name(const std::filesystem::path& file);

// An InputError, "FILE: cannot be read: why", if it is none of these.
[[nodiscard]] RawFile open_raw_file(const std::filesystem::path& file);

}  // namespace aphotic
