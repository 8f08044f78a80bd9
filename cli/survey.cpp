// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic survey RIG -o DIR: raw images as the rig's camera writes them, with noise, navigation
// with errors, and the truth beside both.
#include "cli/terminal.h"
#include "survey/simulate/simulated_survey.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/sha256.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/rig_file.h"
#include "cli/survey_command.h"
#include "plugin/range_render.h"
#include "plugin/survey_render.h"
#include "survey/first_look.h"
#include "survey/images/camera_numbers.h"
#include "survey/navigation/navigation_file.h"
#include "survey/simulate/colmap_poses.h"
#include "survey/simulate/image_truth.h"
#include "validation/tracer.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <string_view>
#include <tuple>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFlightOptions = "Flight";
constexpr const char* kCameraOptions = "Camera";

struct SurveyCommandOptions {
    PlanningOptions planning;
    std::string folder;
    int images = 50;
    std::uint64_t seed = 1;
    std::string flight;
    FlightRanges ranges;
    InstrumentErrors errors;
    double texture = 0.2;
    bool by_povray = false;
    std::vector<std::string> declared;
    Readout readout;  // over the rig's
    double floor_share = 0.25;
    std::optional<double> electrons_per_signal;
    bool has_noise = true;
    std::vector<std::string> truth;
    int jobs = all_cores();
    bool json = false;
};

fs::path scene_of(const SurveyCommandOptions& options, const Rig& rig) {
    return options.planning.scene.empty() ? rig.scene : fs::path(options.planning.scene);
}

bool has_bare_floor(const SurveyCommandOptions& options, const Rig& rig) {
    return scene_of(options, rig).empty() && rig.objects.empty();
}

bool is_by_povray(const SurveyCommandOptions& options, const Rig& rig) {
    return options.by_povray || !has_bare_floor(options, rig);
}

struct MadeSurvey {
    const SurveyCommandOptions& options;
    const SimulatedSurvey& survey;
    std::optional<ManifestModel> model;
};

Json to_json(const MadeSurvey& made) {
    Json json{{"folder", made.survey.folder.string()},
              {"images", made.survey.legs.size()},
              {"camera", to_json(made.survey.camera)}};
    put_model_error(json, made.model);
    return json;
}

// The command that corrects it. None where a correction would take a scene or objects for flat
// floor, or would have to repeat settings of the rig.
void print_next(const MadeSurvey& made) {
    const auto& [options, survey, model] = made;
    if (!has_bare_floor(options, survey.rig)) return;
    const ManifestSettings settings = rig_settings().value_or(ManifestSettings{});
    std::string camera;
    for (const std::string& key : settings.keys) {
        constexpr std::string_view kChosen = "camera=";
        if (key.starts_with(kChosen))
            camera = " --camera " + shell_word(key.substr(kChosen.size()));
        else if (!key.starts_with("camera.scale="))
            return;
    }
    say("Next:\n"
        "  aphotic correct {} --rig {}{} --nav {} --bayer {} --black-level {} --white-level {} -o "
        "{}\n",
        shell_word((survey.folder / "raw").string()),
        shell_word(options.planning.rig_file),
        camera,
        shell_word((survey.folder / "navigation-measured.txt").string()),
        mosaic_name(survey.camera.mosaic),
        survey.camera.black_dn,
        survey.camera.white_dn,
        shell_word((survey.folder / "corrected").string()));
}

void print(const MadeSurvey& made) {
    const auto& [options, survey, model] = made;
    const RawCamera& camera = survey.camera;
    const std::string folder = survey.folder.string();
    say("{}: {} in {}\n"
        "  camera: {}, black level {:g}, white level {:g}, {:.4g} numbers per electron\n"
        "  {}: true poses\n"
        "  {}: as measured, by image; {}: by time\n",
        survey.rig.title,
        counted(survey.legs.size(), "image"),
        folder,
        mosaic_name(camera.mosaic),
        camera.black_dn,
        camera.white_dn,
        camera.gain_dn_per_e,
        (survey.folder / "navigation.txt").string(),
        (survey.folder / "navigation-measured.txt").string(),
        (survey.folder / "navigation-timed.txt").string());
    const TruthAsked& truth = survey.truth;
    for (const auto& [is_asked, where, what] :
         {std::tuple{truth.depth, "depth", "depths along the camera's axis"},
          {truth.normals, "normals", "normals"},
          {truth.reflectance, "reflectance", "reflectance"},
          {truth.poses, "colmap", "poses, in COLMAP's text format"}}) {
        if (is_asked) say("  {}: {}\n", (survey.folder / where).string(), what);
    }
    print_model_error(model);
    print_next(made);
}

// The rig camera's values, replaced by the options'.
Readout readout_of(const Readout& said, Readout readout) {
    if (!said.bayer.empty()) readout.bayer = said.bayer;
    for (const auto part : {&Readout::black_level_dn,
                            &Readout::white_level_dn,
                            &Readout::gain_dn_per_e,
                            &Readout::read_noise_e,
                            &Readout::saturation_e,
                            &Readout::exposure_ms,
                            &Readout::f_number}) {
        if (said.*part) readout.*part = said.*part;
    }
    return readout;
}

Json flight_settings(const SurveyCommandOptions& options) {
    if (!options.flight.empty()) return {{"sha256", sha256_of_file(options.flight)}};
    return {{"altitude_m", options.ranges.altitude_m},
            {"pitch_deg", options.ranges.pitch_deg},
            {"roll_deg", options.ranges.roll_deg}};
}

Json light_settings(const SurveyCommandOptions& options, const Rig& rig) {
    const PlanningOptions& planning = options.planning;
    if (!is_by_povray(options, rig)) {
        Json light{{"by", "lightmap"}};
        if (rig.water.scatters()) light["tolerance"] = planning.plan.tolerance;
        return light;
    }
    Json light{{"by", "povray"},
               {"tolerance", planning.plan.tolerance},
               {"fitted", planning.plan.fitted.value_or(0)},
               {"bands", planning.plan.bands.value_or(0)},
               {"wavelengths_nm", planning.plan.wavelengths_nm},
               {"paths_m", planning.paths_m},
               {"antialias", planning.plan.scene.antialias},
               {"emitter_lamps", planning.emitter_lamps},
               {"veil", planning.veil},
               {"clock", planning.clock},
               {"declared", options.declared}};
    if (planning.plan.scene.format == FrameFormat::Png16) light["frame_format"] = "png16";
    if (const fs::path scene = scene_of(options, rig); !scene.empty())
        light["scene_sha256"] = digest_of_scene(scene);
    return light;
}

void fly(const SurveyCommandOptions& options, SimulatedSurvey& survey) {
    if (options.flight.empty()) {
        survey.legs = flight(options.ranges, options.seed, options.images);
        survey.corners = corners_of(options.ranges);
        return;
    }
    const std::optional<Navigation> navigation =
        read_navigation({.source = options.flight}, {}, &survey.rig);
    terminal_watch(false).looks_wrong(suspicions_of(navigation));
    survey.legs = naming(options.flight, [&] { return flight_of(*navigation); });
    std::vector<Sled> sleds;
    for (const Leg& leg : survey.legs) sleds.push_back(leg.sled);
    survey.corners = corners_of(sleds);
}

TruthAsked truth_asked(const SurveyCommandOptions& options, const Rig& rig) {
    const auto is_asked = [&](const char* kind) {
        return std::ranges::find(options.truth, kind) != options.truth.end();
    };
    for (const char* kind : {"normals", "reflectance"}) {
        if (is_asked(kind) && !scene_of(options, rig).empty())
            throw InputError(
                "--truth: found {} of a POV-Ray scene of your own; allowed with one: depth, poses. "
                "Without its textures POV-Ray gives ranges only",
                kind);
    }
    return {.depth = is_asked("depth"),
            .normals = is_asked("normals"),
            .reflectance = is_asked("reflectance"),
            .poses = is_asked("poses")};
}

SimulatedSurvey survey_of(const SurveyCommandOptions& options) {
    const std::string& file = options.planning.rig_file;
    SimulatedSurvey survey{.folder = options.folder,
                           .rig = read_plausible_rig(file, options.planning.strict),
                           .legs = {},
                           .corners = {},
                           .errors = options.errors,
                           .has_noise = options.has_noise,
                           .seed = options.seed,
                           .jobs = options.jobs};
    fly(options, survey);
    survey.camera = naming(file, [&] {
        const Camera& camera = survey.rig.camera;
        return raw_camera_of(readout_of(options.readout, camera.readout), camera.sensor.is_mono());
    });
    survey.camera.electrons_per_signal =
        options.electrons_per_signal ? *options.electrons_per_signal : naming(file, [&] {
            return electrons_for_share(
                survey.rig, survey.corners, survey.camera.saturation_e, options.floor_share);
        });
    // The rig's exposure is the reference; another scales the brightness.
    survey.camera.electrons_per_signal *=
        relative_exposure(survey.camera.shot, {.reference = shot_of(survey.rig.camera.readout)});
    const bool by_povray = is_by_povray(options, survey.rig);
    survey.texture = by_povray ? 0.0 : options.texture;
    survey.tolerance = options.planning.plan.tolerance;
    survey.made_by = {{"flight", flight_settings(options)},
                      {"light", light_settings(options, survey.rig)}};
    if (!options.declared.empty() && scene_of(options, survey.rig).empty())
        throw InputError("--declare: found without a scene; allowed: with one, by --scene");
    survey.truth = truth_asked(options, survey.rig);
    if (survey.truth.poses) naming(file, [&] { require_colmap(survey.rig.camera, survey.legs); });
    return survey;
}

std::optional<ManifestModel> model_of(const SimulatedSurvey& survey,
                                      const PlanningOptions& planning) {
    Rig rig = survey.rig;
    rig.sled = std::ranges::max(survey.corners, {}, &Sled::altitude_m);
    return model_error(rig, planning.rig_file, planning.model_tolerance, "--altitude");
}

// Each with an image of that kind.
std::vector<SurveyPicture> pictures_of(const SimulatedSurvey& survey, const char* kind) {
    std::vector<SurveyPicture> pictures;
    for (const Leg& leg : survey.legs) {
        pictures.push_back({.number = leg.image,
                            .seed = floor_seed(survey.seed, leg.image),
                            .sled = leg.sled,
                            .image = file_of(survey, kind, leg)});
    }
    return pictures;
}

bool are_there(const std::vector<SurveyPicture>& pictures) {
    return std::ranges::all_of(pictures, [](const auto& one) { return fs::exists(one.image); });
}

// Empty if no picture that it would render is missing.
std::optional<PovRay> povray_for(const SurveyCommandOptions& options,
                                 const SimulatedSurvey& survey) {
    const bool has_light =
        !is_by_povray(options, survey.rig) || are_there(pictures_of(survey, "truth"));
    const bool has_ranges = !survey.truth.depth || scene_of(options, survey.rig).empty() ||
                            are_there(pictures_of(survey, "depth"));
    if (has_light && has_ranges) return std::nullopt;
    PovRay povray = find_povray(options.planning.povray);
    if (!has_light) require_format(povray, options.planning.plan.scene.format);
    return povray;
}

RunOptions run_with_progress(const SurveyCommandOptions& options,
                             ProgressLine& line,
                             std::string_view what) {
    RunOptions run = run_options(options.planning, options.jobs);
    run.report = [&line, what](const FrameProgress& done) {
        line.show(fmt::format("{}: {} of {} frames", what, done.frames_done, done.frames),
                  done.share);
    };
    return run;
}

void make_truth_by_povray(const SurveyCommandOptions& options,
                          const SimulatedSurvey& survey,
                          const PovRay& povray) {
    if (are_there(pictures_of(survey, "truth"))) return;
    PlanningOptions planning = options.planning;
    // The lowest, level pose: the brightest, from which the exposure is derived.
    planning.sled = {.altitude_m =
                         std::ranges::min(survey.corners, {}, &Sled::altitude_m).altitude_m};
    planning.declared = declared_numbers({.number = 1, .sled = *planning.sled}, options.declared);
    if (planning.paths_m.empty()) {
        const PathRange paths =
            paths_of_poses(survey.rig, survey.corners, !scene_of(options, survey.rig).empty());
        planning.paths_m = {paths.shortest_m, paths.longest_m};
    }
    PlannedRender planned = plan_rig(planning);
    ProgressLine line;
    render_pictures(povray,
                    survey.folder / "plan",
                    {.rig = std::move(planned.rig),
                     .plan = std::move(planned.plan),
                     .declared = options.declared},
                    pictures_of(survey, "truth"),
                    run_with_progress(options, line, "rendering"));
}

// By POV-Ray, since only it can read the scene.
void write_ranges_of_scene(const SurveyCommandOptions& options,
                           const SimulatedSurvey& survey,
                           const PovRay& povray) {
    make_folder(survey.folder / "depth");
    ProgressLine line;
    render_ranges(povray,
                  survey.folder / "plan" / "ranges",
                  {.rig = survey.rig,
                   .scene = scene_of(options, survey.rig),
                   .declared = options.declared,
                   .ini_lines = scene_ini(options.planning)},
                  pictures_of(survey, "depth"),
                  run_with_progress(options, line, "ranges"));
}

// By the reference's geometry, without lamps or scattering.
void write_what_is_seen(const SimulatedSurvey& survey) {
    Rig dark = survey.rig;
    dark.strobes.clear();
    dark.water.scatterers.clear();
    const double middle_nm = std::midpoint(dark.camera.range.first_nm, dark.camera.range.last_nm);
    write_seen(survey, [&](const Sled& sled) {
        Rig at_pose = dark;
        at_pose.sled = sled;
        const auto tracer = std::make_shared<const Tracer>(
            at_pose, TraceOptions{.signals = false, .planes_nm = {}});
        return [tracer, middle_nm](double column, double row) -> std::optional<SeenPoint> {
            const auto seen = tracer->seen(column, row, middle_nm);
            if (!seen) return std::nullopt;
            return SeenPoint{
                .point_m = seen->point_m, .normal = seen->normal, .surface = seen->surface};
        };
    });
}

ExitStatus make_survey(const SurveyCommandOptions& options) {
    SimulatedSurvey survey = survey_of(options);
    const std::optional<ManifestModel> model = model_of(survey, options.planning);
    const std::optional<PovRay> povray = povray_for(options, survey);
    require_room(
        {.folder_bytes = missing_bytes(survey)}, survey.folder, options.planning.ignore_needs);
    const FolderLock lock = claim_folder(survey.folder);
    begin_survey(survey);
    ProgressLine line;
    survey.progress = [&](std::string_view kind, double share) {
        line.show(fmt::format("images, {}", kind), share);
    };
    const bool has_scene = !scene_of(options, survey.rig).empty();
    if (is_by_povray(options, survey.rig)) {
        if (povray) make_truth_by_povray(options, survey, *povray);
    } else {
        naming(options.planning.rig_file, [&] { make_truth_by_lightmaps(survey); });
    }
    if (!has_scene)
        write_what_is_seen(survey);
    else if (survey.truth.depth && povray)
        write_ranges_of_scene(options, survey, *povray);
    finish_survey(survey);
    line.wipe();
    show(MadeSurvey{.options = options, .survey = survey, .model = model}, options.json);
    return kDone;
}

void add_flight_options(CLI::App& app, SurveyCommandOptions& options) {
    constexpr int kMostImages = 999999;
    constexpr double kMostBias = 1000.0;
    const OptionGroup group(app, kFlightOptions);
    CLI::Option* images =
        add_option(app, "--images", options.images)->check(in_range(1, kMostImages));
    add_option(app, "--seed", options.seed);
    const auto tilts = in_range(-kMostTilt_deg, kMostTilt_deg);
    const auto altitudes = in_range(kLeastAltitude_m, kMostAltitude_m);
    std::vector<CLI::Option*> random{images};
    FlightRanges& ranges = options.ranges;
    for (const auto& [name, range, allowed] :
         {std::tuple{"--altitude", &ranges.altitude_m, &altitudes},
          {"--pitch", &ranges.pitch_deg, &tilts},
          {"--roll", &ranges.roll_deg, &tilts}}) {
        random.push_back(add_range(app, name, *range, *allowed));
        random.back()->default_str(fmt::format("{:g},{:g}", (*range)[0], (*range)[1]));
    }
    CLI::Option* flown = add_option(app, "--flight", options.flight);
    for (CLI::Option* option : random) flown->excludes(option);
    add_option(app, "--altitude-error", options.errors.altitude_m)->check(not_negative());
    add_option(app, "--attitude-error", options.errors.attitude_deg)->check(not_negative());
    const auto biases = in_range(-kMostBias, kMostBias).description("");
    add_option(app, "--altitude-bias", options.errors.altitude_bias_m)->check(biases);
    add_option(app, "--pitch-bias", options.errors.pitch_bias_deg)->check(biases);
    add_option(app, "--roll-bias", options.errors.roll_bias_deg)->check(biases);
}

void add_floor_options(CLI::App& app, SurveyCommandOptions& options) {
    constexpr double kMostContrast = 10.0;
    add_option(app, "--texture", options.texture)->check(in_range(0.0, kMostContrast));
    add_flag(app, "--by-povray", options.by_povray);
    add_option(app, "--declare", options.declared)->check(refused_by(require_declaration));
    add_option(app, "--truth", options.truth)
        ->delimiter(',')
        ->check(
            CLI::IsMember(std::vector<std::string>{"depth", "normals", "reflectance", "poses"}));
}

void add_readout_options(CLI::App& app, SurveyCommandOptions& options) {
    // The rig's own bounds.
    constexpr double kLeastExposure_ms = 1e-4;
    constexpr double kMostExposure_ms = 1e6;
    constexpr double kLeastFNumber = 0.1;
    constexpr double kMostFNumber = 1000.0;
    const OptionGroup group(app, kCameraOptions);
    Readout& readout = options.readout;
    add_option(app, "--bayer", readout.bayer)
        ->check(CLI::IsMember(std::vector<std::string>{"RGGB", "BGGR", "GRBG", "GBRG", "mono"}));
    add_option(app, "--black-level", readout.black_level_dn)->check(not_negative());
    add_option(app, "--white-level", readout.white_level_dn)->check(not_negative());
    add_option(app, "--saturation-e", readout.saturation_e)->check(positive());
    add_option(app, "--read-noise-e", readout.read_noise_e)->check(not_negative());
    add_option(app, "--gain-dn-per-e", readout.gain_dn_per_e)->check(positive());
    add_option(app, "--exposure-ms", readout.exposure_ms)
        ->check(in_range(kLeastExposure_ms, kMostExposure_ms));
    add_option(app, "--f-number", readout.f_number)->check(in_range(kLeastFNumber, kMostFNumber));
    add_option(app, "--floor-share", options.floor_share)->check(positive());
    add_option(app, "--electrons-per-signal", options.electrons_per_signal)
        ->check(positive())
        ->excludes("--floor-share");
    add_flag(app, "--no-noise", [&options] { options.has_noise = false; });
}

}  // namespace

Action configure_survey(CLI::App& app) {
    const auto options = std::make_shared<SurveyCommandOptions>();
    add_output_folder(app, options->folder)->required();
    add_floor_options(app, *options);
    add_jobs(app, options->jobs);
    add_needs_option(app, options->planning.ignore_needs);
    add_json(app, options->json);
    add_flight_options(app, *options);
    add_readout_options(app, *options);
    add_planning_options(app, options->planning);
    return [options] { return make_survey(*options); };
}

}  // namespace aphotic::cli
