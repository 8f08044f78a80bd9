// SPDX-License-Identifier: BSD-3-Clause
//
// Thumbnails of some images of a corrected survey, evenly spread over it, before and after.
//
//   before = sRGB( k (raw - black) )     the camera's numbers; k puts the kBrightShare quantile of
//                                        all samples of all images at kBrightLevel (preview.h)
//   after  = sRGB( e M b v )             as in result_files.h, from the files as written
//
// Each side has one exposure for all images, so that they appear as dark, bright and uneven as they
// are.
#pragma once

#include "survey/correct/correction_run.h"

#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct SheetPicture {
    int width_px = 0;
    int height_px = 0;
    std::string jpeg{};  // bytes of the file
};

struct SheetImage {
    std::string name;
    std::optional<double> altitude_m{};
    SheetPicture before{};
    SheetPicture after{};
};

inline constexpr std::size_t kMostOnSheet = 24;
inline constexpr int kSheetPicture_px = 280;  // the longer side, at most

// For a survey corrected with these options. Images that were skipped, or have been removed since,
// are omitted.
[[nodiscard]] std::vector<SheetImage> contact_sheet(const Survey& survey,
                                                    const CorrectionOptions& options,
                                                    const CorrectionReport& report);

}  // namespace aphotic
