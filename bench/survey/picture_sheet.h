// SPDX-License-Identifier: BSD-3-Clause
//
// Images side by side on a white sheet, for comparing corrections: a column for each correction,
// shown with an exposure and white balance of its own, and a row for each image.
#pragma once

#include "image/camera_image.h"

#include <array>
#include <filesystem>
#include <vector>

namespace aphotic::survey {

inline constexpr double kShownGrey = 0.35;  // the level of what is grey

struct SheetColumn {
    std::vector<CameraImage> images{};  // all columns' of the same sizes
    std::array<double, kChannels> scale{};
};

// A PNG.
void write_sheet(const std::vector<SheetColumn>& columns, const std::filesystem::path& file);

}  // namespace aphotic::survey
