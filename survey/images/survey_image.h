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
    double rounding = 0.0;  // of its numbers, as a standard deviation: of floats, none
    std::string description;
    std::string date_time;
    double exposure = 1.0;     // times the reference's: what its light is to be divided by
    double light_share = 1.0;  // of the survey's light, that was on; and which strobes were out
    std::uint64_t strobes_out = 0;  // (survey/dropouts.h)
    SharedTags tags{};              // of the file; none: it has none
};

// An InputError when it cannot be read, has not the part that is asked for, or not the channels
// that it should: one for a mosaic or a mono camera, else R, G and B. A raw file says its pattern
// itself, and is refused under another. Of many images one is passed over: messages do not name it,
// for who lists what is skipped does.
[[nodiscard]] SurveyImage read_survey_image(const std::filesystem::path& file,
                                            const CameraNumbers& camera);

// The size of the whole file, by its header alone. An InputError as above.
[[nodiscard]] PlaneSize size_in(const std::filesystem::path& file);

// Leaves its light alone, as at the reference exposure: the black level is taken off the samples,
// and then it is 0.
void take_off_black(SurveyImage& taken);

}  // namespace aphotic
