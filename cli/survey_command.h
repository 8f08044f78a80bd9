// SPDX-License-Identifier: BSD-3-Clause
//
// What the commands on surveys have in common: options, and what the terminal is told meanwhile.
#pragma once

#include "survey/camera_numbers.h"
#include "survey/image_run.h"
#include "survey/run_watch.h"
#include "survey/survey_image.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aphotic::cli {

void add_images(CLI::App& app, std::vector<std::string>& images);
// --bayer, --half, --crop, --black-level, --exposure
void add_camera_options(CLI::App& app, CameraNumbers& camera);
void add_white_level_option(CLI::App& app, CameraNumbers& camera);
// --mask, --format, --compression, and how to encode images to look at. Once parsed, the format has
// all of it, or is refused.
using Settle = std::function<void()>;
[[nodiscard]] Settle add_format_options(CLI::App& app, ResultFormat& format);
// --rig, where the rig tells of its camera alone.
void add_survey_rig(CLI::App& app, std::string& rig);

// What the options say, then what the rig's camera says, if there is one, then the files. An
// InputError where these contradict each other, or have no such crop.
[[nodiscard]] CameraNumbers camera_of(const CameraNumbers& said,
                                      const std::vector<ImageFile>& files,
                                      const Camera* rig);
[[nodiscard]] CameraNumbers camera_of(const CameraNumbers& said,
                                      const std::vector<ImageFile>& files,
                                      const std::string& rig,  // empty: none
                                      bool strict);

// "camera: RGGB, black level 64, white level 4095"; nothing where there is nothing to say.
void print_camera(const CameraNumbers& camera);

// A line of progress, a warning of what looks wrong, or when strict an InputError, and each image
// that is skipped.
[[nodiscard]] RunWatch terminal_watch(bool strict);

// "shown as sRGB ..."
void print_srgb(const SrgbEncoding& encoding, const std::filesystem::path& folder);

// "doubtful pixels: dark 0.1 % ..."
void print_doubts(const RunOutcome& outcome);

}  // namespace aphotic::cli
