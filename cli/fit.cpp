// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic fit RIG --maps MAP... | --images IMAGE... --nav FILE --depth-map DIR  -o DIR: the rig
// that best fits a survey, with errors.
#include "survey/fit/fit.h"
#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/number.h"
#include "base/words.h"
#include "base/work_folder.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/survey_command.h"
#include "cli/terminal.h"
#include "rig/beam/round_profile.h"
#include "survey/camera_station.h"
#include "survey/fit/fit_json.h"
#include "survey/fit/fit_page.h"
#include "survey/fit/fit_samples.h"
#include "survey/fit/fitted_rig.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aphotic::cli {
namespace {

const std::map<std::string, bool> kVignettings{{"cosine", false}, {"radial", true}};

struct FitCommandOptions {
    SurveyInput input;
    std::vector<std::string> maps;
    std::filesystem::path folder;
    FitOptions fit;
    std::vector<std::string> free;
    std::vector<std::string> priors;
    bool is_radial = false;
    double attitude_error_deg = 0.5;
    int blocks = kBlocksAcross;
};

// The rig with the images' number of pixels, if they are smaller and show its whole view. The
// size is counted from the rig's full one, as for `survey --scale`.
RigText scaled_to_images(const CameraNumbers& images, const RigText& text) {
    RigText full = text;
    if (full.has("camera.scale")) full.erase("camera.scale");
    Camera camera = full.rig().camera;
    require_whole_view(images, text.rig().camera);
    if (images.expected && images.expected->image.width_px == camera.width_px) return full;
    const std::optional<PlaneSize> size = fit_to(images, camera);
    if (!size || camera.width_px > size->width_px) return text;
    full.set("camera.scale", static_cast<double>(camera.width_px) / size->width_px);
    return full;
}

FitSamples samples_of(Survey survey,
                      const FitCommandOptions& options,
                      const Rig& rig,
                      const RunWatch& watch) {
    survey.navigation = navigation_of(options.input, survey.files, rig);
    survey.depth = depth_of(options.input, survey.navigation);
    const bool has_relief = survey.depth.has_value();
    if (has_relief) {
        survey.light =
            light_of_rig(rig, survey.navigation, survey.files, true, kVeilOfCorrection, has_relief);
        if (survey.depth->mesh) require_in_view(survey);
    }
    survey.strobes =
        strobes_of_rig(rig, survey.navigation, survey.files, true, kVeilOfCorrection, has_relief);
    return samples_of_images(
        survey, rig, options.blocks, static_cast<std::size_t>(options.fit.threads), watch);
}

// The rig at the size of the data.
struct FitData {
    RigText rig;
    FitSamples samples;
};
FitData data_for(const FitCommandOptions& options, const RigText& text, const RunWatch& watch) {
    const Rig rig = text.rig();
    if (!options.maps.empty())
        return {text, samples_of_maps(options.maps, rig.camera, options.blocks)};
    Survey survey = read_survey(options.input, options.folder, &rig);
    const RigText scaled = scaled_to_images(survey.camera, text);
    return {scaled, samples_of(std::move(survey), options, scaled.rig(), watch)};
}

bool is_given(const CLI::App& app, const std::string& option) {
    return app.count(option) > 0;
}

// Options for images, meaningless for maps; options that --nav requires are checked with it.
constexpr std::array kOfImages{"--nav",
                               "--depth-map",
                               "--relief",
                               "--bayer",
                               "--crop",
                               "--half",
                               "--black-level",
                               "--white-level",
                               "--exposure",
                               "--dropouts",
                               "--allow-skipped"};
void require_use(const CLI::App& app) {
    for (const char* option : kOfImages) {
        if (is_given(app, "--maps") && is_given(app, option))
            throw InputError("{}: found with --maps; allowed: with --images", option);
    }
}

// The initial rig is kept.
void require_other_rig(const FitCommandOptions& options) {
    std::error_code error;
    if (!std::filesystem::equivalent(options.input.rig, options.folder / kFittedRig, error)) return;
    throw InputError("--output: found the folder of {}, which would be replaced; allowed: another",
                     options.input.rig);
}

void require_one_source(const CLI::App& app) {
    const bool has_maps = is_given(app, "--maps");
    const bool has_images = is_given(app, "--images");
    if (has_maps == has_images) {
        throw InputError("found {}; allowed: either --maps or --images",
                         has_maps ? "--maps and --images" : "neither --maps nor --images");
    }
    if (has_images && !is_given(app, "--nav") && !is_given(app, "--depth-map"))
        throw InputError(
            "--images: found no navigation; allowed: with --nav FILE, or --depth-map DIR");
}

// As WORD=SPREAD, possibly with a unit: aim=2deg, altitude=0.1m.
std::map<std::string, double> priors_in(const std::vector<std::string>& given) {
    std::map<std::string, double> priors;
    for (const std::string& one : given) {
        const std::size_t at = one.find('=');
        const std::string word = one.substr(0, at);
        std::string_view number = std::string_view(one).substr(std::min(at, one.size() - 1) + 1);
        const bool is_angle = word == "aim" || word == "attitude" || word.ends_with("_deg");
        const bool is_length = word == "altitude" || word.ends_with("_m");
        if (is_angle && number.ends_with("deg")) number.remove_suffix(3);
        if (is_length && number.ends_with("m")) number.remove_suffix(1);
        const auto spread = read_number<double>(number);
        if (word.empty() || !spread || !priors.emplace(word, *spread).second) {
            throw InputError(
                "--prior: found '{}'; allowed: WORD=SPREAD, each word once, such as aim=2deg, "
                "power=0.1 or altitude=0.1m",
                one);
        }
    }
    return priors;
}

// The strongest ones; all are in fit.json.
void print_confounded(const std::vector<Confounded>& pairs) {
    constexpr std::size_t kShown = 6;
    const std::size_t shown = pairs.size() <= kShown + 1 ? pairs.size() : kShown;
    for (std::size_t i = 0; i < shown; ++i) {
        const Confounded& pair = pairs[i];
        say("confounded: {} and {} ({:+.2f})\n", pair.one, pair.other, pair.correlation);
    }
    if (shown < pairs.size())
        say("confounded: {} more pairs, in {}\n", pairs.size() - shown, kFitNumbers);
}

// No evenness is promised of a rig that leaves a pattern.
void print_verdict(const std::string& rig_name, const FitResult& result) {
    const double expected = 100.0 * result.unevenness;
    if (result.pattern.is_too_large()) {
        say("no evenness is promised, because of that pattern: without it, {:.2g} %. {} as it is "
            "may "
            "correct more evenly\n",
            expected,
            rig_name);
        return;
    }
    say("correction by this rig is expected to be even to {:.2g} %\n", expected);
    if (is_rig_as_good(result))
        say("{} as it is should correct as evenly: its light differs by {:.2g} %, within the fit's "
            "error. Keep it, or hold what you know, such as --hold beam\n",
            rig_name,
            100.0 * result.moved);
    else
        say("correction by {} as it is: even to {:.2g} %\n",
            rig_name,
            100.0 * rig_unevenness(result));
}

PlaneSize size_of(const Rig& rig) {
    return {rig.camera.width_px, rig.camera.height_px};
}

void print_result(const Rig& rig,
                  PlaneSize images,
                  const std::string& rig_name,
                  const FitResult& result,
                  const std::filesystem::path& folder) {
    say("{}: {}\n", rig.title, words_of(result));
    if (images.width_px != rig.camera.width_px) print_scale(size_of(rig), images);
    for (const FittedNumber& one : result.numbers)
        if (!is_curve(one)) say("  {:<36} {}\n", one.key, with_error(one));
    if (std::ranges::count(result.numbers, "power", &FittedNumber::word) > 0)
        say("powers keep the rig's sum: images do not determine it\n");
    for (const FittedNumber& one : result.numbers)
        if (!one.is_determined) say("{}\n", words_of(one));
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const Strobe& strobe = rig.strobes[s];
        const bool is_fitted_round = result.state.beams[result.state.beam_of[s]].is_round();
        if (is_fitted_round && !is_round(strobe.beam))
            say("beam '{}' of {} is not round, the fitted one is: --hold beam keeps the rig's\n",
                strobe.beam.name,
                strobe.name);
    }
    if (!result.fixed.empty())
        say("not fitted, as the rig has them: {}\n", fmt::join(result.fixed, ", "));
    print_confounded(result.confounded);
    for (const Suspicion& one : result.looks_wrong)
        say("looks wrong: {}: {}\n", one.about, one.what);
    print_verdict(rig_name, result);
    say("  {}  the rig\n", (folder / kFittedRig).string());
    say("  {}  errors and covariance\n", (folder / kFitNumbers).string());
    say("  {}  to look at\n", (folder / kFitPage).string());
}

ExitStatus fit_survey(const CLI::App& app, const FitCommandOptions& options) {
    require_one_source(app);
    require_use(app);
    require_other_rig(options);
    const RigText text = read_rig_text_as_set(options.input.rig);
    const Rig rig = text.rig();
    naming(options.input.rig, [&] { require_bare_floor(rig); });
    check_plausible(rig, options.input.rig, options.input.strict);
    FitOptions fit_options = options.fit;
    fit_options.attitude_error_rad = options.attitude_error_deg * kRadiansPerDegree;
    if (is_given(app, "--free")) fit_options.free = options.free;
    if (is_given(app, "--vignetting")) fit_options.has_radial_vignetting = options.is_radial;
    fit_options.priors = priors_in(options.priors);
    require_fit_options(text, fit_options);
    const WorkFolder place(options.folder);
    const RunWatch watch = terminal_watch(options.input.strict);
    const FitData data = data_for(options, text, watch);
    const FitResult result = fit(data.rig, data.samples, fit_options, watch);
    write_fitted_rig(text, result, options.folder);
    nlohmann::ordered_json json = to_json(result);
    const PlaneSize size = size_of(data.rig.rig());
    if (size.width_px != rig.camera.width_px)
        json["fitted_to"]["rig_scale"] = static_cast<double>(size.width_px) / rig.camera.width_px;
    if (!options.input.depth.place.empty()) json["depth"] = to_json(options.input.depth);
    write_text_file(options.folder / kFitNumbers, json_text(json));
    write_fit_page(options.folder / kFitPage, data.rig, data.samples, result);
    if (options.input.json) {
        say_text(json_text(json));
    } else {
        print_result(rig, size, options.input.rig, result, options.folder);
    }
    if (options.input.strict && !result.looks_wrong.empty()) return kAnswerIsNo;
    return status_of_skips(data.samples.skipped.size(),
                           data.samples.skipped.size() + data.samples.images.size(),
                           options.input);
}

}  // namespace

Action configure_fit(CLI::App& app) {
    const auto options = std::make_shared<FitCommandOptions>();
    options->fit.threads = all_cores();
    add_rig(app, options->input.rig);
    add_output_folder(app, options->folder)->required();
    add_option(app, "--maps", options->maps);
    add_option(app, "--images", options->input.images);
    add_navigation_options(app, options->input);
    add_depth_options(app, options->input);
    add_option(app, "--beam", options->fit.beam)->transform(word_of(kFitBeams));
    add_flag(app, "--beam-each", options->fit.has_beam_each);
    add_option(app, "--free", options->free)->delimiter(',');
    add_option(app, "--hold", options->fit.hold)->delimiter(',');
    add_option(app, "--prior", options->priors)->delimiter(',');
    add_option(app, "--vignetting", options->is_radial)->transform(word_of(kVignettings));
    add_option(app, "--altitude-error", options->fit.altitude_error_m)->check(not_negative());
    add_option(app, "--attitude-error", options->attitude_error_deg)->check(not_negative());
    add_option(app, "--blocks", options->blocks)->check(in_range(8, 1000));
    add_camera_options(app, options->input);
    add_dropouts(app, options->input, false);
    add_jobs(app, options->fit.threads);
    add_outcome_options(app, options->input);
    return [&app, options] { return fit_survey(app, *options); };
}

}  // namespace aphotic::cli
