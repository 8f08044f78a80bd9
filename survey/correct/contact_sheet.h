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

#include "report/page.h"
#include "survey/correct/correction_run.h"

#include <cstddef>

namespace aphotic {

inline constexpr std::size_t kMostOnSheet = 24;
inline constexpr int kSheetPicture_px = 280;  // the longer side, at most

// For a survey corrected with these options. Images that were skipped, or have been removed since,
// are omitted. The captions are names and altitudes.
[[nodiscard]] PageFigures contact_sheet(const Survey& survey,
                                        const CorrectionOptions& options,
                                        const CorrectionReport& report);

}  // namespace aphotic
