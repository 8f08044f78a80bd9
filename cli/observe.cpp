// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic observe IMAGES... --nav FILE -o MAP.exr: averages the images of one altitude into their
// common pattern of light.
#include "base/degrees.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/survey_command.h"
#include "cli/terminal.h"
#include "survey/camera_station.h"
#include "survey/correct/observation.h"
#include "survey/images/camera_numbers.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>
#include <optional>

namespace aphotic::cli {
namespace {

struct ObserveCommandOptions {
    SurveyInput input;
    std::string output;
    ObservationOptions observation;
};

std::string angle_words(double radians) {
    return std::isnan(radians) ? "unknown" : fmt::format("{:.2f} deg", radians / kRadiansPerDegree);
}

void print_observation(const Observation& observation, const std::string& map_file) {
    say("{}: the {} of {} at {:.3f} m, pitch {}, roll {} on average\n",
        map_file,
        observation.average == Average::Trimmed ? "trimmed mean"
                                                : name_of(kAverages, observation.average),
        counted(observation.images, "image"),
        observation.sled.altitude_m,
        angle_words(observation.sled.pitch_rad),
        angle_words(observation.sled.roll_rad));
    if (std::isfinite(observation.relative_error)) {
        say("standard error: {:.2g} of the map's mean (rms)\n", observation.relative_error);
    }
    say("{} at other altitudes, {} skipped\n",
        counted(observation.outside, "image"),
        observation.skipped.size());
    for (const MarkedImage& one : observation.marked)
        say("left out: {}: {}\n", one.image, words_of(one));
}

// The camera's rays, for the view of a mesh.
void look_at_mesh(Survey& survey, std::optional<Rig> rig) {
    if (!rig) throw InputError("--relief needs --rig, which has the camera's rays");
    fit_to(survey.camera, rig->camera);
    survey.light.size = {rig->camera.width_px, rig->camera.height_px};
    survey.light.relief =
        std::make_shared<const ReliefMapMaker>(*rig, LightmapOptions{.has_veil = false});
    require_in_view(survey);
}

ExitStatus observe_survey(const ObserveCommandOptions& options) {
    const SurveyInput& input = options.input;
    const std::optional<Rig> rig = rig_of(input);
    Survey survey = read_survey(input, options.output, rig ? &*rig : nullptr);
    survey.navigation = read_navigation(input, survey.files, rig ? &*rig : nullptr);
    survey.depth = depth_of(input, survey.navigation);
    if (survey.depth && survey.depth->mesh) look_at_mesh(survey, rig);
    const Observation observation =
        observe(survey, options.observation, terminal_watch(input.strict));
    write_observation(options.output, observation);
    if (input.json) {
        nlohmann::ordered_json json = to_json(observation, options.output);
        json["camera"] = to_json(survey.camera);
        if (survey.depth) json["depth"] = to_json(*survey.depth);
        if (survey.navigation->notes()) json["navigation"] = to_json(*survey.navigation->notes());
        say_text(json_text(json));
    } else {
        print_observation(observation, options.output);
        print_camera(survey);
        print_navigation(survey);
        print_relief(survey);
    }
    return status_of_skips(observation.skipped.size(), survey.files.size(), input);
}

void add_average_options(CLI::App& app, ObservationOptions& options) {
    add_option(app, "--method", options.average)->transform(word_of(kAverages));
    add_option(app, "--trim", options.trim)->check(in_range(0.0, 0.49));
    add_flag(app, "--normalise", options.normalise);
    add_flag(app, "--demosaic", options.demosaic);
}

}  // namespace

Action configure_observe(CLI::App& app) {
    const auto options = std::make_shared<ObserveCommandOptions>();
    add_images(app, options->input);
    add_navigation_options(app, options->input)->required();
    add_depth_maps(app, options->input);
    add_option(app, "--output", options->output)->required();
    add_option(app, "--altitude", options->observation.altitude_m)->check(positive())->required();
    add_option(app, "--within", options->observation.within_m)->check(not_negative());
    add_average_options(app, options->observation);
    add_survey_rig(app, options->input);
    add_camera_options(app, options->input, false);
    add_dropouts(app, options->input, false);
    add_option(app, "--memory", options->observation.memory_mb)->check(positive());
    add_jobs(app, options->observation.jobs);
    add_outcome_options(app, options->input);
    return [options] { return observe_survey(*options); };
}

}  // namespace aphotic::cli
