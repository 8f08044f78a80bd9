// SPDX-License-Identifier: BSD-3-Clause
//
// What the commands on surveys have in common: what they take, and what the terminal is told
// meanwhile.
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

// How many images may be skipped, and the command still end with 0: a number of them, or a share of
// all that it was given. A script that works on ten thousand images need not stop for three.
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
    std::string rig;  // empty: none
    NavigationOptions navigation;
    DepthMaps depth{};  // without a place: none; of a mesh that is not read yet, without its scene
    std::optional<bool> is_by_depth{};  // none: where the navigation tells depths
    CameraNumbers camera;
    Dropouts dropouts = Dropouts::Mark;
    bool strict = false;
    AllowedSkips allowed_skips;
    bool json = false;
};

void add_images(CLI::App& app, SurveyInput& input);
// --rig, where the rig tells of its camera alone.
void add_survey_rig(CLI::App& app, SurveyInput& input);
// --nav and all that says how it is to be understood.
CLI::Option* add_navigation_options(CLI::App& app, SurveyInput& input);
// --depth-map and --depth-unit, --relief and what it is to be understood by; and all that says how
// ranges are to be understood.
CLI::Option* add_depth_maps(CLI::App& app, SurveyInput& input);
void add_depth_options(CLI::App& app, SurveyInput& input);
// --bayer, --half, --crop, --black-level, --exposure; where brightness has an end, --white-level.
// has_map: an image's exposure can be told by what it is divided by.
void add_camera_options(CLI::App& app,
                        SurveyInput& input,
                        bool has_white = true,
                        bool has_map = false);
// --dropouts. corrects: by the light that was on.
void add_dropouts(CLI::App& app, SurveyInput& input, bool corrects);
// --strict, --allow-skipped, --json
void add_outcome_options(CLI::App& app, SurveyInput& input);
// --mask, --format, --compression, and how to encode images to look at. Once parsed, the format has
// all of it, or is refused.
using Settle = std::function<void()>;
[[nodiscard]] Settle add_format_options(CLI::App& app, ResultFormat& format);

// The input's rig, if it is named only for its camera.
[[nodiscard]] std::optional<Rig> rig_of(const SurveyInput& input);

// The images except those in the output; and the camera from the options, then from the rig, if
// there is one, then from the files. An InputError if these contradict each other, or have no such
// crop.
[[nodiscard]] Survey read_survey(const SurveyInput& input,
                                 const std::filesystem::path& output,
                                 const Rig* rig);
// The depth maps, or the mesh, which is read here. None: the floor is a plane.
[[nodiscard]] std::optional<DepthMaps> depth_of(const SurveyInput& input,
                                                const std::optional<Navigation>& navigation);
// None where depth maps do without.
[[nodiscard]] std::optional<Navigation> navigation_of(const SurveyInput& input,
                                                      const std::vector<ImageFile>& files,
                                                      const Rig& rig);
[[nodiscard]] Navigation read_navigation(const SurveyInput& input,
                                         const std::vector<ImageFile>& files,
                                         const Rig* rig);

// A line of progress, a warning of what looks wrong, or when strict an InputError, and each skipped
// image and each dropout.
[[nodiscard]] RunWatch terminal_watch(bool strict);

// "camera: RGGB, black level 64, white level 4095", "navigation: ..."; nothing if there is nothing
// to report.
void print_camera(const Survey& survey);
void print_navigation(const Survey& survey);
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
