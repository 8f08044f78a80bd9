// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic correct IMAGES... --rig RIG --nav FILE -o DIR: survey images divided by the map of their
// own altitude and attitude.
// aphotic baseline NAME IMAGES... -o DIR: images corrected without a model of the lamps.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/model_error.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/survey_command.h"
#include "cli/terminal.h"
#include "image/exr.h"
#include "survey/camera_station.h"
#include "survey/correct/correction_run.h"
#include "survey/correct/ifdo_results.h"
#include "survey/images/camera_numbers.h"
#include "survey/light_at.h"

#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace aphotic::cli {
namespace {

struct CorrectCommandOptions {
    std::string baseline;  // empty: by the lamp model
    SurveyInput input;
    std::string map;
    bool no_veil = false;
    double tolerance = kVeilOfCorrection;
    double model_tolerance = kModelTolerance;
    std::string ifdo;
    std::optional<std::pair<double, double>> altitudes_m;
    CorrectionOptions correction;
    std::optional<double> electrons;
};

// One number if all channels have the same, as for a mono camera.
std::string gain_words(const PerChannel& gain) {
    if (gain[0] == gain[1] && gain[1] == gain[2]) return fmt::format("{:.6g}", gain[0]);
    return fmt::format("{:.6g} (R), {:.6g} (G), {:.6g} (B)", gain[0], gain[1], gain[2]);
}

void print_report(const CorrectionReport& report,
                  const Survey& survey,
                  const std::filesystem::path& folder,
                  bool has_page) {
    const RunOutcome& run = *report.run;
    say("{}: {} corrected in {:.1f} s, {} kept as they were, {} skipped\n",
        folder.string(),
        counted(run.corrected, "image"),
        report.seconds,
        run.kept,
        run.skipped.size());
    print_camera(survey);
    if (survey.light.rig_size) print_scale(*survey.light.rig_size, survey.light.size);
    print_relief(survey);
    std::string from;
    if (!report.gain.images.empty()) {
        from = ", taken from " + counted(report.gain.images.size(), "image");
    }
    if (!report.gain.folder.empty()) from = ", that of " + report.gain.folder;
    say("  gain {}{}\n", gain_words(report.gain.gain), from);
    if (report.srgb) print_srgb(*report.srgb, folder);
    print_doubts(run);
    if (!report.pattern.logarithm.empty()) say("  {}\n", words_of(report.pattern));
    if (!report.not_checked.empty()) say("  not checked: {}\n", report.not_checked);
    say("  {}\n", (folder / kCorrectionNotes).string());
    if (has_page) say("  {}\n", (folder / kReportPage).string());
    for (const Skipped& one : run.skipped) {
        say("  skipped: {}: {}\n", one.image, one.why);
    }
    for (const MarkedImage& one : run.marked) say("  {}: {}\n", one.image, words_of(one));
    print_navigation(survey);
}

void print_baseline(const CorrectionReport& report, const Survey& survey) {
    const RunOutcome& run = *report.run;
    say("{}: {} corrected by {}, {}{} skipped\n",
        report.folder,
        counted(run.corrected, "image"),
        report.baseline,
        run.kept > 0 ? fmt::format("{} kept as they were, ", run.kept) : "",
        run.skipped.size());
    print_camera(survey);
    print_navigation(survey);
    if (report.srgb) print_srgb(*report.srgb, report.folder);
}

// Memory of an image's planes is kept for the next image, which has the same sizes. If it were
// returned to the system, each of its pages would be cleared again, a tenth of the processor's
// time.
void keep_memory() {
#ifdef __GLIBC__
    ::mallopt(M_ARENA_MAX, 1);  // the arenas of threads hold no large planes
    ::mallopt(M_MMAP_MAX, 0);
    ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

// At the highest altitude, where the model error is largest.
std::optional<ManifestModel> model_error_of(const CorrectCommandOptions& options,
                                            Rig rig,
                                            const Survey& survey) {
    if (options.no_veil || !rig.water.scatters()) return std::nullopt;
    const std::vector<Sled> sleds = sleds_of(survey.navigation, survey.files);
    if (!sleds.empty()) rig.sled = std::ranges::max(sleds, {}, &Sled::altitude_m);
    return model_error(rig, options.input.rig, options.model_tolerance, "--altitude");
}

// The request, and for water that scatters the model error.
struct Task {
    Survey survey;
    std::optional<ManifestModel> model{};
    Readout readout{};  // of the rig
};

Task baseline_task(const CorrectCommandOptions& options) {
    const SurveyInput& input = options.input;
    const std::optional<Rig> rig = rig_of(input);
    Survey survey = read_survey(input, options.correction.run.folder, rig ? &*rig : nullptr);
    if (needs_altitude(*options.correction.baseline) && !input.navigation.source.empty())
        survey.navigation = read_navigation(input, survey.files, rig ? &*rig : nullptr);
    return {.survey = std::move(survey)};
}

Task map_task(const CorrectCommandOptions& options) {
    Survey survey = read_survey(options.input, options.correction.run.folder, nullptr);
    const auto& expected = survey.camera.expected;
    survey.light = light_of_map(
        options.map, !options.no_veil, expected ? std::optional(expected->image) : std::nullopt);
    expect(survey.camera, survey.light.size, "like the map");
    return {.survey = std::move(survey)};
}

Task rig_task(const CorrectCommandOptions& options) {
    const std::string& file = options.input.rig;
    Rig rig = read_plausible_rig(file, options.input.strict);
    Survey survey = read_survey(options.input, options.correction.run.folder, &rig);
    require_whole_view(survey.camera, rig.camera);
    const std::optional<PlaneSize> own = fit_to(survey.camera, rig.camera);
    survey.navigation = navigation_of(options.input, survey.files, rig);
    survey.depth = depth_of(options.input, survey.navigation);
    const bool has_relief = survey.depth.has_value();
    survey.light = naming(file, [&] {
        return light_of_rig(
            rig, survey.navigation, survey.files, !options.no_veil, options.tolerance, has_relief);
    });
    if (has_relief && survey.depth->mesh) require_in_view(survey);
    survey.strobes = strobes_of_rig(
        rig, survey.navigation, survey.files, !options.no_veil, options.tolerance, has_relief);
    survey.light.rig_size = own;
    expect(survey.camera, survey.light.size, "like the map");
    const auto model = model_error_of(options, rig, survey);
    return {.survey = std::move(survey), .model = model, .readout = rig.camera.readout};
}

Task task_of(CorrectCommandOptions& options) {
    if (options.correction.baseline) return baseline_task(options);
    NavigationOptions& navigation = options.input.navigation;
    const bool has_rig = !options.input.rig.empty();
    if (has_rig != options.map.empty()) {
        throw InputError("--rig with --nav, or --map: one of them is needed");
    }
    if (!has_rig && (!navigation.source.empty() || !options.input.depth.place.empty()))
        throw InputError("--map is one for all images: --nav, --depth-map and --relief need --rig");
    if (const auto& range = options.altitudes_m)
        std::tie(navigation.least_altitude_m, navigation.most_altitude_m) = *range;
    return has_rig ? rig_task(options) : map_task(options);
}

void take_noise(CorrectCommandOptions& options, const Readout& readout) {
    options.correction.limit.electrons_per_number =
        options.electrons.value_or(electrons_per_number(readout));
    if (!options.correction.read_noise) options.correction.read_noise = dark_noise_dn(readout);
}

// Read before anything is corrected, so that an error in it costs no time.
struct IfdoTask {
    Ifdo of_raw;
    std::filesystem::path place;
};

std::optional<IfdoTask> ifdo_task(const CorrectCommandOptions& options) {
    if (options.ifdo.empty()) return std::nullopt;
    const std::string text = read_text_file(options.ifdo, kMostIfdo_bytes);
    return IfdoTask{.of_raw = parse_ifdo(options.ifdo, text),
                    .place = ifdo_place(options.ifdo, options.correction.run.folder)};
}

void write_ifdo(const IfdoTask& task,
                const CorrectCommandOptions& options,
                const Survey& survey,
                const CorrectionReport& report) {
    std::optional<Rig> rig;
    if (!options.input.rig.empty()) rig = read_rig_as_set(options.input.rig);
    const IfdoResults made = write_ifdo_of_results(
        task.of_raw, task.place, survey, options.correction, report, rig ? &*rig : nullptr);
    if (!options.input.json) say("  {}: {}\n", made.file.string(), counted(made.images, "image"));
    for (const std::string& image : made.without_item)
        warn("{}: has no item of its own for {}", options.ifdo, image);
}

ExitStatus correct(CorrectCommandOptions options) {
    if (!options.baseline.empty()) {
        const auto* const name = std::ranges::find(kBaselineNames, options.baseline);
        options.correction.baseline = static_cast<Baseline>(name - kBaselineNames.begin());
    }
    keep_memory();
    set_exr_threads(0);  // the threads work on different images
    if (options.input.navigation.source.empty() && !options.input.rig.empty())
        options.input.navigation.source = options.ifdo;
    const std::optional<IfdoTask> task = ifdo_task(options);
    const auto [survey, model, readout] = task_of(options);
    CorrectionOptions& correction = options.correction;
    correction.run.folder = share_folder(correction.run.folder, correction.share);
    take_noise(options, readout);
    const CorrectionReport report =
        correct_survey(survey, correction, terminal_watch(options.input.strict));
    if (options.input.json) {
        nlohmann::ordered_json json = to_json(report);
        if (!correction.baseline) put_model_error(json, model);
        say_text(json_text(json));
    } else if (correction.baseline) {
        print_baseline(report, survey);
    } else {
        print_report(report, survey, correction.run.folder, correction.report);
        print_model_error(model);
    }
    // A share lacks some of the images that it would have to cover.
    if (task && correction.share.is_whole()) write_ifdo(*task, options, survey, report);
    const std::size_t skipped = report.run->skipped.size();
    const std::size_t images = report.run->corrected + report.run->kept + skipped;
    return status_of_skips(skipped, images, options.input);
}

void add_light_options(CLI::App& app, CorrectCommandOptions& options) {
    constexpr double kMostTolerance = 0.1;
    add_option(app, "--rig", options.input.rig);
    add_navigation_options(app, options.input);
    add_depth_options(app, options.input);
    add_option(app, "--map", options.map);
    add_option(app, "--tolerance", options.tolerance)->check(in_range(0.0, kMostTolerance));
    add_flag(app, "--no-veil", options.no_veil);
    add_range(app, "--altitude", options.altitudes_m, not_negative());
}

void add_raw_options(CLI::App& app, CorrectCommandOptions& options) {
    add_camera_options(app, options.input, true, true);
    add_dropouts(app, options.input, true);
    add_flag(app, "--keep-mosaic", options.correction.keep_mosaic);
    add_option(app, "--read-noise", options.correction.read_noise)->check(not_negative());
    add_option(app, "--electrons", options.electrons)->check(not_negative());
}

[[nodiscard]] Settle add_result_options(CLI::App& app, CorrectCommandOptions& options) {
    constexpr double kLeastShare = 1e-6;
    constexpr double kLeastNoise = 1e-3;
    constexpr double kMostNoise = 10.0;
    constexpr int kMostEdge_px = 100;
    constexpr std::size_t kMostImages = 10000;
    auto* gain = add_option(app, "--gain", options.correction.gain)
                     ->delimiter(',')
                     ->expected(1, kChannels)
                     ->check(positive());
    auto* gain_from = add_option(app, "--gain-from", options.correction.gain_from)->excludes(gain);
    add_option(app, "--middle", options.correction.middle)->check(positive())->excludes(gain_from);
    add_option(app, "--gain-images", options.correction.gain_images)
        ->check(in_range(1, kMostImages));
    add_option(app, "--least-light", options.correction.limit.share)
        ->check(in_range(kLeastShare, 1.0));
    add_option(app, "--most-noise", options.correction.limit.relative)
        ->check(in_range(kLeastNoise, kMostNoise));
    add_option(app, "--edge-px", options.correction.edge_px)->check(in_range(0, kMostEdge_px));
    Settle settle = add_format_options(app, options.correction.run.format);
    add_option(app, "--ifdo", options.ifdo);
    return settle;
}

void add_baseline_options(CLI::App& app, BaselineOptions& options) {
    add_option(app, "--sigma", options.sigma)->check(in_range(1e-4, 10.0));
    add_option(app, "--low", options.low)->check(in_range(0.0, 10.0));
    add_option(app, "--high", options.high)->check(in_range(0.0, 10.0));
    add_option(app, "--tiles", options.tiles)->check(in_range(1, 256));
    add_option(app, "--clip", options.clip)->check(in_range(1.0, 1e6));
    add_option(app, "--order", options.order)->check(in_range(0, 12));
    add_option(app, "--bin", options.bin_m)->check(in_range(1e-3, 1e4));
}

// Options of both commands, except images and results.
Action configure_run(CLI::App& app,
                     const std::shared_ptr<CorrectCommandOptions>& options,
                     const Settle& settle) {
    add_jobs(app, options->correction.run.jobs);
    add_share(app, "--share", options->correction.share);
    add_outcome_options(app, options->input);
    return [options, settle] {
        settle();
        return correct(*options);
    };
}

}  // namespace

Action configure_correct(CLI::App& app) {
    const auto options = std::make_shared<CorrectCommandOptions>();
    add_images(app, options->input);
    add_light_options(app, *options);
    add_output_folder(app, options->correction.run.folder)->required();
    add_model_tolerance(app, options->model_tolerance);
    add_raw_options(app, *options);
    const Settle settle = add_result_options(app, *options);
    add_flag(app, "--report", options->correction.report);
    return configure_run(app, options, settle);
}

Action configure_baseline(CLI::App& app) {
    const auto options = std::make_shared<CorrectCommandOptions>();
    options->correction.run.format.format = "exr";
    add_option(app, "NAME", options->baseline)
        ->check(CLI::IsMember(std::set<std::string>(kBaselineNames.begin(), kBaselineNames.end())))
        ->required();
    add_images(app, options->input);
    add_output_folder(app, options->correction.run.folder)->required();
    add_navigation_options(app, options->input);
    add_baseline_options(app, options->correction.of_baselines);
    add_survey_rig(app, options->input);
    add_camera_options(app, options->input);
    add_dropouts(app, options->input, true);
    const Settle settle = add_format_options(app, options->correction.run.format);
    return configure_run(app, options, settle);
}

}  // namespace aphotic::cli
