// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic baseline NAME IMAGES... -o DIR: images corrected without a model of the lamps.
#include "base/json_text.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "cli/survey_command.h"
#include "image/exr.h"
#include "survey/baseline_run.h"
#include "survey/navigation_csv.h"

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
    std::string navigation;
    CameraNumbers camera;
    BaselineRunOptions baseline;
    bool strict = false;
    bool json = false;
};

ExitStatus correct_by_baseline(BaselineCommandOptions options) {
    const auto name = std::ranges::find(kBaselineNames, options.name);
    options.baseline.baseline = static_cast<Baseline>(name - kBaselineNames.begin());
    const std::filesystem::path& folder = options.baseline.run.folder;
    Survey survey{.files = image_files(options.images, folder),
                  .navigation = {},
                  .light = {},
                  .camera = options.camera};
    if (needs_altitude(options.baseline.baseline) && !options.navigation.empty()) {
        survey.navigation = read_navigation_csv(options.navigation, Sled{});
    }
    set_exr_threads(0);  // the images themselves are spread over the threads
    const BaselineReport report =
        aphotic::correct_by_baseline(survey, options.baseline, terminal_watch(options.strict));
    const RunOutcome& run = *report.run;
    if (options.json) {
        fmt::print("{}", json_text(to_json(report)));
    } else {
        fmt::print("{}: {} corrected by {}, {}{} skipped\n",
                   folder.string(),
                   counted(run.corrected, "image"),
                   options.name,
                   run.kept > 0 ? fmt::format("{} kept as they were, ", run.kept) : "",
                   run.skipped.size());
    }
    return run.skipped.empty() ? kDone : kAnswerIsNo;
}

void add_baseline_options(CLI::App& app, BaselineOptions& options) {
    app.add_option("--sigma",
                   options.sigma,
                   "of the blur of illumination-reflectance and homomorphic, as a share of the\n"
                   "image's width")
        ->check(in_range(1e-4, 10.0))
        ->capture_default_str();
    app.add_option("--low", options.low, "homomorphic: the gain of what is slow")
        ->check(in_range(0.0, 10.0))
        ->capture_default_str();
    app.add_option("--high", options.high, "homomorphic: the gain of what is quick")
        ->check(in_range(0.0, 10.0))
        ->capture_default_str();
    app.add_option("--tiles", options.tiles, "local-equalisation: tiles across and down")
        ->check(in_range(1, 256))
        ->capture_default_str();
    app.add_option("--clip",
                   options.clip,
                   "local-equalisation: the most a bin counts, in mean bins; 1 changes nothing")
        ->check(in_range(1.0, 1e6))
        ->capture_default_str();
    app.add_option("--order", options.order, "of the polynomials")
        ->check(in_range(0, 12))
        ->capture_default_str();
    app.add_option("--bin", options.bin_m, "binned-polynomial: the width of a bin of altitude [m]")
        ->check(in_range(1e-3, 1e4))
        ->capture_default_str();
}

}  // namespace

Action configure_baseline(CLI::App& app) {
    const auto options = std::make_shared<BaselineCommandOptions>();
    app.add_option("NAME", options->name, fmt::format("{}", fmt::join(kBaselineNames, ", ")))
        ->check(CLI::IsMember(std::set<std::string>(kBaselineNames.begin(), kBaselineNames.end())))
        ->required();
    app.add_option("IMAGES", options->images, "images, and folders of images: TIFF, PNG, EXR, JPEG")
        ->required();
    app.add_option("-o,--output", options->baseline.run.folder, "where the corrected images go")
        ->type_name("DIR")
        ->required();
    app.add_option("--nav",
                   options->navigation,
                   "the altitude of each image, for binned-polynomial; as for observe")
        ->type_name("FILE");
    add_baseline_options(app, options->baseline.settings);
    add_camera_options(app, options->camera);
    add_white_level_option(app, options->camera);
    add_format_options(app, options->baseline.run.format);
    app.add_option("--jobs", options->baseline.run.jobs, "images at a time")
        ->check(in_range(1, 1024))
        ->capture_default_str();
    add_strict_option(app, options->strict);
    app.add_flag("--json", options->json, "print DIR/baseline.json");
    app.footer(
        "What users do without a model of the lamps, to hold it against. The polynomials learn "
        "from\n"
        "all images given, the others from each alone. An EXR holds the camera's own numbers less\n"
        "the black level; a TIFF or PNG has 65535 where the camera is saturated. Given again, it\n"
        "goes on where it stopped. An image that cannot be used is told and skipped; the exit\n"
        "status is then 1. A mask's pixel is a sum of 2 saturated, 4 black, 16 clipped; 0 is "
        "good.");
    return [options] { return correct_by_baseline(*options); };
}

}  // namespace aphotic::cli
