// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic observe IMAGES... --nav FILE -o MAP.exr: the images of one altitude averaged into the
// pattern of light that they share.
#include "base/json_text.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "cli/survey_command.h"
#include "survey/navigation_csv.h"
#include "survey/observation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>
#include <numbers>

namespace aphotic::cli {
namespace {

struct ObserveCommandOptions {
    std::vector<std::string> images;
    std::string navigation;
    std::string output;
    CameraNumbers camera;
    ObservationOptions observation;
    bool strict = false;
    bool json = false;
};

std::string angle_words(double radians) {
    return std::isnan(radians) ? "unknown"
                               : fmt::format("{:.2f} deg", radians * 180.0 / std::numbers::pi);
}

void print_observation(const Observation& observation, const std::string& map_file) {
    fmt::print(
        "{}: the {} of {} at {:.3f} m, pitch {}, roll {} on average\n",
        map_file,
        observation.average == Average::Trimmed ? "trimmed mean" : name_of(observation.average),
        counted(observation.images, "image"),
        observation.sled.altitude_m,
        angle_words(observation.sled.pitch_rad),
        angle_words(observation.sled.roll_rad));
    if (std::isfinite(observation.relative_error)) {
        fmt::print("standard error: {:.2g} of the map's mean (rms)\n", observation.relative_error);
    }
    fmt::print("{} at other altitudes, {} skipped\n",
               counted(observation.outside, "image"),
               observation.skipped.size());
}

ExitStatus observe_survey(const ObserveCommandOptions& options) {
    const Survey survey{.files = image_files(options.images, options.output),
                        .navigation = read_navigation_csv(options.navigation, Sled{}),
                        .light = {},
                        .camera = options.camera};
    const Observation observation =
        observe(survey, options.observation, terminal_watch(options.strict));
    write_observation(options.output, observation);
    if (options.json) {
        fmt::print("{}", json_text(to_json(observation, options.output)));
    } else {
        print_observation(observation, options.output);
    }
    return observation.skipped.empty() ? kDone : kAnswerIsNo;
}

void add_average_options(CLI::App& app, ObservationOptions& options) {
    app.add_option("--method", options.average, "mean, median or trimmed (mean)")
        ->transform(CLI::CheckedTransformer(kAverages).description(""))
        ->type_name("METHOD")
        ->default_str("mean");
    app.add_option("--trim",
                   options.trim,
                   "the share of samples that is left out at either end, of a trimmed mean")
        ->check(in_range(0.0, 0.49))
        ->capture_default_str();
    app.add_flag("--normalise",
                 options.normalise,
                 "first divide each image by the mean of its samples, so that patterns alone are\n"
                 "averaged");
    app.add_flag(
        "--demosaic",
        options.demosaic,
        "of a mosaic's map, fill the other channels of each pixel from the sites about it");
}

}  // namespace

Action configure_observe(CLI::App& app) {
    const auto options = std::make_shared<ObserveCommandOptions>();
    app.add_option("IMAGES", options->images, "images, and folders of images: TIFF, PNG, EXR, JPEG")
        ->required();
    app.add_option("--nav",
                   options->navigation,
                   "where the sled was: CSV with the columns image and altitude_m, or HabCam's\n"
                   "lines of name, altitude, pitch and roll")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->output, "the map to write")
        ->type_name("MAP.exr")
        ->required();
    app.add_option("--altitude", options->observation.altitude_m, "the altitude to observe [m]")
        ->check(positive())
        ->required();
    app.add_option("--within", options->observation.within_m, "how far an image may be off it [m]")
        ->check(not_negative())
        ->capture_default_str();
    add_average_options(app, options->observation);
    add_camera_options(app, options->camera);
    app.add_option("--memory",
                   options->observation.memory_mb,
                   "for the images that a median or a trimmed mean holds at a time [MB]")
        ->check(positive())
        ->capture_default_str();
    app.add_option("--jobs", options->observation.jobs, "images read at a time")
        ->check(in_range(1, 1024))
        ->capture_default_str();
    add_strict_option(app, options->strict);
    app.add_flag("--json", options->json, "print what was done as JSON");
    app.footer(
        "MAP.exr holds the average in R, G, B, the number of images in count.R ..., the standard\n"
        "error in stderr.R ...; what was never observed is NaN. An image that cannot be used is\n"
        "reported and skipped; the exit status is then 1.");
    return [options] { return observe_survey(*options); };
}

}  // namespace aphotic::cli
