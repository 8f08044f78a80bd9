// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images as cameras write them, read from files of any format.
#pragma once

#include "image/image_tags.h"
#include "survey/images/camera_numbers.h"
#include "survey/images/raw_image.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace aphotic {

struct SurveyImage {
    RawImage raw;  // in the camera's own numbers: the part of the file that is the image
    Crop crop;     // which part
    SensorLevels levels;
    double rounding = 0.0;  // standard deviation of its numbers' rounding; 0 for floats
    std::string description;
    std::string date_time;
    double exposure = 1.0;     // relative to the reference: its light is divided by it
    double light_share = 1.0;  // share of the survey's light that was on, and strobes that were out
    std::uint64_t strobes_out = 0;  // (survey/dropouts.h)
    SharedTags tags{};              // the file's; empty: it has none
};

// An InputError if it cannot be read, lacks the requested part, or has unexpected channels: it must
// have one for a mosaic or a mono camera, otherwise R, G and B. A raw file states its own pattern,
// and any other is rejected. Messages do not name the image; the list of skipped images does.
[[nodiscard]] SurveyImage read_survey_image(const std::filesystem::path& file,
                                            const CameraNumbers& camera);

// The size of the whole file, from its header only. An InputError as above.
[[nodiscard]] PlaneSize size_in(const std::filesystem::path& file);

// Reduces it to its light, at the reference exposure: the black level is subtracted from the
// samples, and is 0 afterwards.
void take_off_black(SurveyImage& taken);

}  // namespace aphotic
