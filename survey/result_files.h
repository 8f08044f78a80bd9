// SPDX-License-Identifier: BSD-3-Clause
//
// What is made of an image, as files: the image itself in one of three formats, and when asked for
// a mask of its doubtful pixels. Linear, with what the source says of itself.
//
//   tiff, png  16 bits, 65535 for 1; what does not fit is clipped, and marked
//   exr        32-bit floats, which clip nothing
//
// Beside them, when asked for, the image to look at (srgb_files.h).
//
// In a mask each pixel's 8 bits are its doubts (correction.h), 0 is good.
#pragma once

#include "image/any_image.h"
#include "image/exr.h"
#include "survey/correction.h"
#include "survey/image_files.h"
#include "survey/journal.h"
#include "survey/srgb_files.h"
#include "survey/survey_image.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct ResultFormat {
    std::string format = "tiff";
    bool mask = false;
    Compression compression = Compression::Fast;
    std::optional<SrgbFormat> srgb{};  // none: linear alone

    [[nodiscard]] bool clips() const { return format != "exr"; }
};

inline const std::map<std::string, Compression> kCompressions{
    {"none", Compression::None}, {"fast", Compression::Fast}, {"small", Compression::Small}};
[[nodiscard]] std::string name_of(Compression compression);

// The files that are made of an image, below the folder of results: NAME.tif, NAME.mask.png.
[[nodiscard]] std::vector<std::filesystem::path> results_of(const ImageFile& file,
                                                            const ResultFormat& format);

// Writes them, but for the one in sRGB, and returns how many pixels have each doubt. more:
// attributes of an EXR.
Counts write_results(const std::filesystem::path& folder,
                     const ImageFile& file,
                     CorrectedImage result,
                     const SurveyImage& source,
                     const ResultFormat& format,
                     const ExrAttributes& more = {});

}  // namespace aphotic
