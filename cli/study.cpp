// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic study RIG -o DIR: a render with several choices of wavelengths, the time of each on this
// machine and its error against the reference.
#include "validation/study.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "image/exr.h"
#include "scene_gen/scene_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct StudyCommandOptions {
    std::string rig_file;
    std::string folder;
    std::string povray;
    double stall_timeout_s = kStall_s;
    std::vector<double> tolerances;
    std::vector<int> fitted;
    std::vector<int> bands;
    bool quick = false;
    bool strict = false;
    bool json = false;
    bool ignore_needs = false;
};

// A setting and its plan, made before anything is rendered: an impossible one is refused at once.
struct PlannedSetting {
    StudySetting setting;
    RenderPlan plan;
};

std::vector<PlannedSetting> planned_settings(const StudyCommandOptions& asked, const Rig& rig) {
    StudyCommandOptions options = asked;
    if (options.tolerances.empty() && options.fitted.empty() && options.bands.empty()) {
        options.tolerances = {PlanRequest{}.tolerance};
        options.fitted = options.quick ? std::vector{3, 6} : std::vector{3, 6, 9};
        options.bands =
            options.quick ? std::vector{6, 12} : std::vector{6, 9, 12, 18, 24, 36, 48, 72};
    }
    std::vector<PlannedSetting> settings;
    const auto add = [&](StudySetting setting, auto PlanRequest::*what, auto value) {
        PlanRequest request;
        request.*what = value;
        const bool is_new = std::ranges::none_of(
            settings, [&](const PlannedSetting& one) { return one.setting.name == setting.name; });
        if (!is_new) return;
        settings.push_back({std::move(setting),
                            naming(options.rig_file, [&] { return plan_render(rig, request); })});
    };
    for (const double tolerance : options.tolerances) {
        add({.name = fmt::format("tolerance-{}", tolerance),
             .words = fmt::format("tolerance {}", tolerance)},
            &PlanRequest::tolerance,
            tolerance);
    }
    for (const int count : options.fitted) {
        add({.name = fmt::format("fitted-{}", count),
             .words = counted(static_cast<std::size_t>(count), "fitted wavelength")},
            &PlanRequest::fitted,
            count);
    }
    for (const int count : options.bands) {
        add({.name = fmt::format("bands-{}", count),
             .words = counted(static_cast<std::size_t>(count), "equal band"),
             .equal_bands = true},
            &PlanRequest::bands,
            count);
    }
    return settings;
}

void print_study(const Study& study, const fs::path& folder) {
    const std::vector<bool> front = pareto_front(study.measures);
    say("{}: {} x {} pixels, {} on {}\n",
        study.rig_title,
        study.width_px,
        study.height_px,
        counted(study.measures.size(), "setting"),
        counted(static_cast<std::size_t>(study.cores), "core"));
    say("{:>34}  time (s)   promised    max |e|   on edges\n", "frames");
    for (std::size_t i = 0; i < study.measures.size(); ++i) {
        const StudyMeasure& m = study.measures[i];
        say("{} {:<24} {:6} {:8.2f} {:10.2e} {:10.2e} {:10.2e}\n",
            front[i] ? "*" : " ",
            m.setting.words,
            m.frames,
            m.total_s(),
            m.promise,
            m.max_error,
            m.max_error_on_edges);
    }
    say("  * on the Pareto front: no other is both faster and more accurate\n");
    say("  {}/study.html, study.csv, study.json\n", folder.string());
}

// Of the setting with most frames.
ResourceNeeds needs_of_renders(const Rig& rig,
                               const std::vector<PlannedSetting>& settings,
                               int cores) {
    ImageSize size{.width_px = rig.camera.width_px, .height_px = rig.camera.height_px};
    std::size_t frames = 0;
    for (const PlannedSetting& one : settings) {
        size.wavelengths = std::max(size.wavelengths, one.plan.wavelengths.size());
        frames = std::max(frames, one.plan.frames());
    }
    return study_needs(size, frames, cores);
}

ExitStatus study_rig(const StudyCommandOptions& options) {
    const fs::path folder = options.folder;
    Rig rig = read_plausible_rig(options.rig_file, options.strict);
    if (!rig.scene.empty()) {
        throw InputError(
            "{}: scene: found {}; allowed: none, since a study uses the rig's own floor, which the "
            "reference knows",
            options.rig_file,
            rig.scene.string());
    }
    if (options.quick) rig = quick_rig(std::move(rig));
    const PovRay povray = find_povray(options.povray);
    Study study{.rig_title = rig.title,
                .rig_sha256 = rig.digest,
                .width_px = rig.camera.width_px,
                .height_px = rig.camera.height_px,
                .aphotic_version = APHOTIC_VERSION,
                .povray_version = povray.version,
                .cores = all_cores()};
    const std::vector<PlannedSetting> planned = planned_settings(options, rig);
    require_room(needs_of_renders(rig, planned, study.cores), folder, options.ignore_needs);
    set_exr_threads(study.cores);
    const FolderLock lock = claim_folder(folder);
    std::vector<StudySetting> settings;
    for (const PlannedSetting& one : planned) settings.push_back(one.setting);
    StudyHands hands;
    std::optional<ProgressLine> line(std::in_place);
    hands.progress = [&](std::string_view what, double share) { line->show(what, share); };
    hands.render = [&](std::size_t index, const fs::path& its_folder) {
        line.reset();
        warn("{} of {}: {}", index + 1, settings.size(), settings[index].words);
        const RenderPlan& plan = planned[index].plan;
        RenderedFrames frames = render_frames(
            {.jobs = study.cores, .stall_s = options.stall_timeout_s}, [&](const RunOptions& run) {
                return render(povray, its_folder, make_scene_set(rig, plan), run);
            });
        return StudyFrames{.manifest = std::move(frames.result.manifest),
                           .promise = plan.promise(),
                           .render_s = frames.povray_s};
    };
    run_study(study, rig, settings, folder, hands);
    line.reset();
    write_study(study, folder);
    if (options.json) {
        say_text(study_json(study));
    } else {
        print_study(study, folder);
    }
    return kDone;
}

}  // namespace

Action configure_study(CLI::App& app) {
    const auto options = std::make_shared<StudyCommandOptions>();
    add_rig(app, options->rig_file);
    add_strict_option(app, options->strict);
    add_output_folder(app, options->folder)->required();
    add_option(app, "--tolerance", options->tolerances)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(in_range(0.0, 1.0));
    add_option(app, "--fitted", options->fitted)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(in_range(1, kMostFitted));
    add_option(app, "--bands", options->bands)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(in_range(1, kMostBands));
    add_flag(app, "--quick", options->quick);
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json);
    add_povray_options(app, options->povray, options->stall_timeout_s);
    return [options] { return study_rig(*options); };
}

}  // namespace aphotic::cli
