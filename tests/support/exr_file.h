// SPDX-License-Identifier: BSD-3-Clause
//
// An EXR as planes, one below the other.
#pragma once

#include "image/exr.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

inline void write_exr(const std::filesystem::path& file,
                      int width_px,
                      std::span<const float> planes,
                      const std::vector<std::string>& channels = {"R", "G", "B"}) {
    const int height_px = static_cast<int>(planes.size() / channels.size()) / width_px;
    ExrWriter exr(file, width_px, height_px, channels, {});
    exr.write_rows(height_px, planes);
    exr.finish();
}

inline std::vector<float> read_exr(const std::filesystem::path& file,
                                   const std::vector<std::string>& channels = {"R", "G", "B"}) {
    return ExrReader(file).planes(channels);
}

}  // namespace aphotic
