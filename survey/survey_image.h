// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images as cameras write them, read from files of any format.
#pragma once

#include "survey/raw_image.h"

#include <filesystem>
#include <optional>
#include <string>

namespace aphotic {

// What the user says of the camera.
struct CameraNumbers {
    Mosaic mosaic = Mosaic::None;
    float black_level = 0.0F;
    std::optional<float> white_level;  // none: the largest that the file's integers hold
};

struct SurveyImage {
    RawImage raw;  // in the camera's own numbers
    SensorLevels levels;
    double rounding = 0.0;  // of its numbers, as a standard deviation: of floats, none
    std::string description;
    std::string date_time;
};

// An InputError when it cannot be read, or has not the channels that it should: one for a mosaic,
// else R, G and B. Of many images one is passed over: messages do not name it, for who lists what
// is skipped does.
[[nodiscard]] SurveyImage read_survey_image(const std::filesystem::path& file,
                                            const CameraNumbers& camera);

// Leaves its light alone: the black level is taken off the samples.
void take_off_black(SurveyImage& taken);

}  // namespace aphotic
