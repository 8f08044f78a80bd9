// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images as files: raw ones as cameras write them, corrected ones and their masks.
#pragma once

#include "cli/any_image.h"
#include "lightmap/correction.h"
#include "lightmap/raw_image.h"

#include <filesystem>
#include <optional>
#include <string>

namespace aphotic::cli {

// What the user says of the camera.
struct CameraNumbers {
    Mosaic mosaic = Mosaic::None;
    float black_level = 0.0F;
    std::optional<float> white_level;  // none: the largest that the file's integers hold
};

struct SurveyImage {
    RawImage raw;
    SensorLevels levels;
    double rounding = 0.0;  // of its numbers, as a standard deviation: of floats, none
    std::string description;
    std::string date_time;
};

// An InputError when it cannot be read, is not of this size, or has not the channels that it
// should.
[[nodiscard]] SurveyImage read_survey_image(const std::filesystem::path& file,
                                            PlaneSize size,
                                            const CameraNumbers& camera);

// In the format that the extension names: .exr of floats, all others of 16 bits; with what the
// source says of itself.
void write_corrected(const std::filesystem::path& file,
                     const RawImage& image,
                     const SurveyImage& source);

// 8 bits a pixel, the numbers themselves.
void write_mask(const std::filesystem::path& file, const CorrectedImage& image);

}  // namespace aphotic::cli
