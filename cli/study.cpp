// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic study RIG -o DIR: settings of a render tried side by side, their time here and their
// error against the reference.
#include "base/atomic_file.h"
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
#include "scene_gen/pov_scene.h"
#include "scene_gen/scene_set.h"
#include "validation/study_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct StudyCommandOptions {
    std::string rig_file;
    std::string folder;
    std::string povray;
    double stall_timeout_s = kStall_s;
    double tolerance = 1e-3;
    bool quick = false;
    bool strict = false;
    bool json = false;
    bool ignore_needs = false;
};

RenderPlan plan_for(const Rig& rig, const StudySetting& setting) {
    PlanRequest request;
    if (setting.fitted > 0) request.fitted = setting.fitted;
    if (setting.bands > 0) request.bands = setting.bands;
    request.scene.wavelengths_per_frame = setting.per_frame;
    request.scene.soft_edges = setting.one_soft_lamp;
    if (setting.png) request.scene.format = FrameFormat::Png16;
    return plan_render(rig, request);
}

// In POV-Ray's settings, which must hold the line.
void change_setting(std::string& ini, const std::string& line, const std::string& to) {
    const std::size_t at = ini.find(line + "\n");
    if (at == std::string::npos) throw std::logic_error("no such line: " + line);
    ini.replace(at, line.size(), to);
}

// The frames of one setting by POV-Ray.
StudyFrames render_setting(const PovRay& povray,
                           double stall_s,
                           const Rig& rig,
                           const StudySetting& setting,
                           const fs::path& folder) {
    const RenderPlan plan = plan_for(rig, setting);
    SceneSet set = make_scene_set(rig, plan);
    if (setting.antialias) {
        change_setting(set.ini,
                       "Antialias=off",
                       "Antialias=on\nSampling_Method=2\nAntialias_Threshold=0.01\n"
                       "Antialias_Depth=3\nJitter=off");
    }
    RenderedFrames frames =
        render_frames(povray, folder, set, {.jobs = setting.jobs, .stall_s = stall_s});
    return {.manifest = std::move(frames.result.manifest),
            .promise = plan.promise(),
            .render_s = frames.povray_s};
}

void print_study(const Study& study, const fs::path& folder) {
    const std::vector<bool> front = pareto_front(study.measures);
    say("{}: {} x {} pixels, {} on {}\n",
        study.rig_title,
        study.width_px,
        study.height_px,
        counted(study.measures.size(), "setting"),
        counted(static_cast<std::size_t>(study.cores), "core"));
    say("  {:<48} {:>6} {:>8} {:>10} {:>10} {:>10}\n",
        "",
        "frames",
        "time (s)",
        "max |e|",
        "off edges",
        "on edges");
    for (std::size_t i = 0; i < study.measures.size(); ++i) {
        const StudyMeasure& m = study.measures[i];
        say("{} {:<48} {:6} {:8.2f} {:10.2e} {:10.2e} {:10.2e}\n",
            front[i] ? "*" : " ",
            m.setting.words,
            m.frames,
            m.total_s(),
            m.max_error(),
            m.max_error_off_edges(),
            m.max_error_on_edges());
    }
    say("  * on the Pareto front: no other is as fast and as right\n");
    const auto best = recommended(study.measures, study.tolerance);
    if (best) {
        say("  for {}: {}\n", study.tolerance, study.measures[*best].setting.words);
    } else {
        say("  for {}: none of these\n", study.tolerance);
    }
    say("  {}/study.html, study.csv, study.json\n", folder.string());
}

// Of the setting that has most. Behind a port each wavelength may take a frame of its own.
DiskNeeds needs_of_renders(const Rig& rig, const std::vector<StudySetting>& settings, int cores) {
    int wavelengths = 0;
    int frames = 0;
    for (const StudySetting& s : settings) {
        const int count = std::max(s.fitted, s.bands);
        wavelengths = std::max(wavelengths, count);
        const int per_frame = rig.camera.port ? 1 : s.per_frame;
        frames = std::max(frames, (count + per_frame - 1) / per_frame);
    }
    return study_needs({.width_px = rig.camera.width_px,
                        .height_px = rig.camera.height_px,
                        .wavelengths = static_cast<std::size_t>(wavelengths)},
                       static_cast<std::size_t>(frames),
                       cores);
}

ExitStatus study_rig(const StudyCommandOptions& options) {
    const fs::path folder = options.folder;
    Rig rig = read_plausible_rig(options.rig_file, options.strict);
    if (!rig.scene.empty()) {
        throw InputError(
            "{}: scene: found {}; allowed: none, for a study is of the rig's own floor, which the "
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
                .cores = all_cores(),
                .quick = options.quick,
                .tolerance = options.tolerance};
    const std::vector<StudySetting> settings = study_settings(rig, options.quick, study.cores);
    require_room(needs_of_renders(rig, settings, study.cores), folder, options.ignore_needs);
    set_exr_threads(study.cores);
    const FolderLock lock = claim_folder(folder);
    StudyHands hands;
    hands.render = [&](const Rig& small, const StudySetting& setting, const fs::path& its_folder) {
        return render_setting(povray, options.stall_timeout_s, small, setting, its_folder);
    };
    std::optional<ProgressLine> line(std::in_place);
    hands.progress = [&](std::string_view what, double share) {
        if (line) line->show(what, share);
    };
    hands.begins = [&](const StudySetting& setting, std::size_t index) {
        line.reset();
        warn("{} of {}: {}", index + 1, settings.size(), setting.words);
    };
    run_study(study, rig, settings, folder, hands);
    line.reset();
    write_study(study, folder);
    if (options.json) {
        say_text(read_text_file(folder / "study.json"));
    } else {
        print_study(study, folder);
    }
    return kDone;
}

Action configure_study(CLI::App& app) {
    const auto options = std::make_shared<StudyCommandOptions>();
    add_rig(app, options->rig_file);
    add_strict_option(app, options->strict);
    add_output_folder(app, options->folder)->required();
    app.add_option("--tolerance",
                   options->tolerance,
                   "Recommend the fastest setting within this relative error")
        ->check(in_range(0.0, 1.0))
        ->option_text("E")
        ->capture_default_str();
    app.add_flag("--quick",
                 options->quick,
                 "Try only the settings that matter most, small enough for two minutes");
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json, "Print study.json");
    add_povray_options(app, options->povray, options->stall_timeout_s);
    app.footer(
        "Interrupted, it continues with the settings not yet measured when run again. Leave the "
        "machine alone meanwhile: the times are wall times.");
    return [options] { return study_rig(*options); };
}

}  // namespace

const Command kStudy{"study",
                     kCheckCommands,
                     "Measure how accuracy trades for time on this machine",
                     configure_study};

}  // namespace aphotic::cli
