// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images as files: raw ones as cameras write them, corrected ones and their masks.
#pragma once

#include "image/any_image.h"
#include "survey/correction.h"
#include "survey/raw_image.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

// What the user says of the camera.
struct CameraNumbers {
    Mosaic mosaic = Mosaic::None;
    float black_level = 0.0F;
    std::optional<float> white_level;  // none: the largest that the file's integers hold
};

// --bayer and --black-level.
void add_camera_options(CLI::App& app, CameraNumbers& camera);

struct SurveyImage {
    RawImage raw;  // in the camera's own numbers
    SensorLevels levels;
    double rounding = 0.0;  // of its numbers, as a standard deviation: of floats, none
    std::string description;
    std::string date_time;
};

// An InputError when it cannot be read, or has not the channels that it should: one for a mosaic,
// else R, G and B. Of many images one is passed over: messages do not name it, for print_skipped()
// does.
[[nodiscard]] SurveyImage read_survey_image(const std::filesystem::path& file,
                                            const CameraNumbers& camera);

// Its light alone: the black level is taken off.
[[nodiscard]] RawImage without_black(SurveyImage taken);

// An InputError unless it is of this size, "as the map has".
void require_size(const RawImage& image, int width_px, int height_px, std::string_view as);

struct Skipped {
    std::string image;
    std::string why;
};

void print_skipped(const std::filesystem::path& file, const std::string& why);

// In the format that the extension names: .exr of floats, all others of 16 bits; with what the
// source says of itself.
void write_corrected(const std::filesystem::path& file,
                     const RawImage& image,
                     const SurveyImage& source,
                     Compression compression = Compression::Fast);

// 8 bits a pixel, the numbers themselves.
void write_mask(const std::filesystem::path& file,
                const CorrectedImage& image,
                Compression compression);

}  // namespace aphotic
