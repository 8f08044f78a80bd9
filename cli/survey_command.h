// SPDX-License-Identifier: BSD-3-Clause
//
// What the commands on surveys have in common: options, and what the terminal is told meanwhile.
#pragma once

#include "survey/image_run.h"
#include "survey/run_watch.h"
#include "survey/survey_image.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace aphotic::cli {

void add_images(CLI::App& app, std::vector<std::string>& images);
void add_camera_options(CLI::App& app, CameraNumbers& camera);  // --bayer and --black-level
void add_white_level_option(CLI::App& app, CameraNumbers& camera);
void add_format_options(CLI::App& app, ResultFormat& format);  // --mask, --format, --compression
void add_strict_option(CLI::App& app, bool& strict);

// A line of progress, a warning of what looks wrong, or when strict an InputError, and each image
// that is skipped.
[[nodiscard]] RunWatch terminal_watch(bool strict);

// "doubtful pixels: dark 0.1 % ..."
void print_doubts(const RunOutcome& outcome);

}  // namespace aphotic::cli
