// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic baseline NAME IMAGES... -o DIR: images corrected without a model of the lamps.
#include "base/json_text.h"
#include "base/words.h"
#include "cli/allowed_skips.h"
#include "cli/command.h"
#include "cli/navigation_options.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/survey_command.h"
#include "cli/terminal.h"
#include "image/exr.h"
#include "survey/baseline_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>

namespace aphotic::cli {
namespace {

struct BaselineCommandOptions {
    std::string name;
    std::vector<std::string> images;
    NavigationOptions navigation;
    std::string rig;
    CameraNumbers camera;
    BaselineRunOptions baseline;
    bool strict = false;
    AllowedSkips allowed_skips;
    bool json = false;
};

ExitStatus correct_by_baseline(BaselineCommandOptions options) {
    const auto name = std::ranges::find(kBaselineNames, options.name);
    options.baseline.baseline = static_cast<Baseline>(name - kBaselineNames.begin());
    const std::filesystem::path& folder = options.baseline.run.folder;
    Survey survey{.files = image_files(options.images, folder), .camera = options.camera};
    survey.camera = camera_of(survey.camera, survey.files, options.rig, options.strict);
    if (needs_altitude(options.baseline.baseline) && !options.navigation.source.empty()) {
        survey.navigation = read_navigation_with(options.rig, options.navigation, survey.files);
    }
    set_exr_threads(0);  // the images themselves are spread over the threads
    const BaselineReport report =
        aphotic::correct_by_baseline(survey, options.baseline, terminal_watch(options.strict));
    const RunOutcome& run = *report.run;
    if (options.json) {
        say_text(json_text(to_json(report)));
    } else {
        say("{}: {} corrected by {}, {}{} skipped\n",
            folder.string(),
            counted(run.corrected, "image"),
            options.name,
            run.kept > 0 ? fmt::format("{} kept as they were, ", run.kept) : "",
            run.skipped.size());
        print_camera(survey.camera);
        print_navigation(survey.navigation);
        if (report.srgb) print_srgb(*report.srgb, folder);
    }
    return status_of_skips(run.skipped.size(), survey.files.size(), options.allowed_skips);
}

void add_baseline_options(CLI::App& app, BaselineOptions& options) {
    app.add_option(
           "--sigma",
           options.sigma,
           "illumination-reflectance, homomorphic: width of the blur as a share of the image's")
        ->check(in_range(1e-4, 10.0))
        ->capture_default_str();
    app.add_option("--low", options.low, "homomorphic: gain of low frequencies")
        ->check(in_range(0.0, 10.0))
        ->capture_default_str();
    app.add_option("--high", options.high, "homomorphic: gain of high frequencies")
        ->check(in_range(0.0, 10.0))
        ->capture_default_str();
    app.add_option("--tiles", options.tiles, "local-equalisation: tiles across and down")
        ->check(in_range(1, 256))
        ->capture_default_str();
    app.add_option("--clip",
                   options.clip,
                   "local-equalisation: clip histograms at N mean bins; 1 changes nothing")
        ->check(in_range(1.0, 1e6))
        ->capture_default_str();
    app.add_option(
           "--order", options.order, "log-polynomial, binned-polynomial: order of the polynomials")
        ->check(in_range(0, 12))
        ->capture_default_str();
    app.add_option("--bin",
                   options.bin_m,
                   "binned-polynomial, altitude-exponential: width of an altitude bin, in metres")
        ->check(in_range(1e-3, 1e4))
        ->capture_default_str();
}

Action configure_baseline(CLI::App& app) {
    const auto options = std::make_shared<BaselineCommandOptions>();
    app.add_option("NAME", options->name, fmt::format("{}", fmt::join(kBaselineNames, ", ")))
        ->check(CLI::IsMember(std::set<std::string>(kBaselineNames.begin(), kBaselineNames.end())))
        ->required();
    add_images(app, options->images);
    add_output_folder(app, options->baseline.run.folder)->required();
    add_navigation_options(app, options->navigation);
    add_baseline_options(app, options->baseline.settings);
    add_survey_rig(app, options->rig);
    add_camera_options(app, options->camera);
    add_white_level_option(app, options->camera);
    const Settle settle = add_format_options(app, options->baseline.run.format);
    add_jobs(app, options->baseline.run.jobs, "Correct N images at a time");
    add_strict_option(app, options->strict);
    add_allow_skipped(app, options->allowed_skips);
    add_json(app, options->json, "Print DIR/baseline.json");
    app.footer(
        "The polynomials and exponentials learn from all images given; the others correct each "
        "image "
        "by itself. An EXR holds the camera's own numbers less the black level; a TIFF or PNG has "
        "65535 where "
        "the camera saturates. Interrupted, it continues where it stopped when run again. Images "
        "that cannot be used are reported and skipped; the exit status is 1 when these are more "
        "than "
        "--allow-skipped. A mask's pixel "
        "is a sum of 2 saturated, 4 black, 16 clipped by the format; 0 is good.");
    return [options, settle] {
        settle();
        return correct_by_baseline(*options);
    };
}

}  // namespace

const Command kBaseline{"baseline",
                        kSurveyCommands,
                        "Correct images without a model of the lamps, for comparison",
                        configure_baseline};

}  // namespace aphotic::cli
