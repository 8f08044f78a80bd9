// SPDX-License-Identifier: BSD-3-Clause
//
// The common parts of the survey commands: their options, and their messages to the terminal.
#pragma once

#include "cli/command.h"
#include "survey/correct/image_run.h"
#include "survey/navigation/navigation_file.h"
#include "survey/run_watch.h"
#include "survey/survey.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace aphotic::cli {

// The number of images that may be skipped with an exit status of 0, or their share of all given
// images. A script for ten thousand images need not stop for three.
//
//   3        three images
//   0.01     a hundredth of them, rounded down; so does 1%
struct AllowedSkips {
    double number = 0.0;
    bool is_share = false;

    [[nodiscard]] std::size_t of(std::size_t images) const;
};

struct SurveyInput {
    std::vector<std::string> images;
    std::string rig;  // empty without one
    NavigationOptions navigation;
    DepthMaps depth{};  // without a place: none; of a mesh that is not read yet, without its scene
    std::optional<bool> is_by_depth{};  // empty: if the navigation gives depths
    CameraNumbers camera;
    Dropouts dropouts = Dropouts::Mark;
    bool strict = false;
    AllowedSkips allowed_skips;
    bool json = false;
};

void add_images(CLI::App& app, SurveyInput& input);
// --rig, if only the rig's camera is used.
void add_survey_rig(CLI::App& app, SurveyInput& input);
// --nav and the options for its interpretation.
CLI::Option* add_navigation_options(CLI::App& app, SurveyInput& input);
// --depth-map and --depth-unit, --relief, and the options for the interpretation of either and of
// ranges.
CLI::Option* add_depth_maps(CLI::App& app, SurveyInput& input);
void add_depth_options(CLI::App& app, SurveyInput& input);
// --bayer, --half, --crop, --black-level, --exposure; --white-level if brightness is limited.
// has_map: an image's exposure can be derived from the map that divides it.
void add_camera_options(CLI::App& app,
                        SurveyInput& input,
                        bool has_white = true,
                        bool has_map = false);
// --dropouts. corrects: with the lamps that were on.
void add_dropouts(CLI::App& app, SurveyInput& input, bool corrects);
// --strict, --allow-skipped, --json
void add_outcome_options(CLI::App& app, SurveyInput& input);
// --mask, --format, --compression, and the encoding of images for viewing. After parsing, the
// format is complete or was refused.
using Settle = std::function<void()>;
[[nodiscard]] Settle add_format_options(CLI::App& app, ResultFormat& format);

// The input's rig, if it is named only for its camera.
[[nodiscard]] std::optional<Rig> rig_of(const SurveyInput& input);

// The images except those in the output; and the camera from the options, then from the rig, if
// given, then from the files. An InputError if these contradict each other or do not contain the
// crop.
[[nodiscard]] Survey read_survey(const SurveyInput& input,
                                 const std::filesystem::path& output,
                                 const Rig* rig);
// The depth maps, or the mesh, which is read here. Empty: the floor is a plane.
[[nodiscard]] std::optional<DepthMaps> depth_of(const SurveyInput& input,
                                                const std::optional<Navigation>& navigation);
// Empty if depth maps do not need it.
[[nodiscard]] std::optional<Navigation> navigation_of(const SurveyInput& input,
                                                      const std::vector<ImageFile>& files,
                                                      const Rig& rig);
[[nodiscard]] Navigation read_navigation(const SurveyInput& input,
                                         const std::vector<ImageFile>& files,
                                         const Rig* rig);

// Reports a line of progress, warnings about implausible data, or if strict an InputError, and each
// skipped image and dropout.
[[nodiscard]] RunWatch terminal_watch(bool strict);

// "camera: RGGB, black level 64, white level 4095", "navigation: ..."; prints nothing if there is
// nothing to report.
void print_camera(const Survey& survey);
void print_navigation(const Survey& survey);
// "rig of 1360 x 1024 pixels scaled to 136 x 102"
void print_scale(PlaneSize of_rig, PlaneSize of_images);
// "relief: depth maps of depth, along the axis"; "relief: reef.ply, east-north-up, by altitudes"
void print_relief(const Survey& survey);

// "shown as sRGB ..."
void print_srgb(const SrgbEncoding& encoding, const std::filesystem::path& folder);

// "doubtful pixels: dark 0.1 % ..."
void print_doubts(const RunOutcome& outcome);

// kDone if no more were skipped than allowed. Skips are reported, with both numbers.
[[nodiscard]] ExitStatus status_of_skips(std::size_t skipped,
                                         std::size_t images,
                                         const SurveyInput& input);

}  // namespace aphotic::cli
