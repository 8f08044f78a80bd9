// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic render RIG -o DIR: the main job, from a rig file to a camera image through POV-Ray.
#include "plugin/render.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/option_checks.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/rendering.h"

#include <fmt/format.h>

#include <memory>
#include <thread>

namespace aphotic::cli {
namespace {

struct RenderCommandOptions {
    PlanningOptions planning;
    std::string folder;
    int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    PreviewOptions preview;
    bool json = false;
};

ExitStatus render_rig(const RenderCommandOptions& options) {
    const PlannedRender planned = plan_rig(options.planning);
    const SceneSet scenes = scenes_of(planned, options.planning);
    const PovRay povray = povray_for(planned, options.planning, options.folder);
    require_place_for_scenes(options.folder, scenes);
    require_room(needs_of(scenes, options.folder, options.jobs),
                 options.folder,
                 options.planning.ignore_needs);

    const FolderLock lock = claim_folder(options.folder);
    const RenderedFrames frames = render_frames(povray,
                                                options.folder,
                                                scenes,
                                                {.jobs = options.jobs,
                                                 .report = {},
                                                 .library_paths = options.planning.library_paths,
                                                 .stall_s = options.planning.stall_timeout_s});
    const RenderResult& result = frames.result;
    const int jobs = scenes.scene_writes_files ? 1 : options.jobs;

    auto outcome =
        integrate_folder(options.folder, result.manifest, options.preview, options.folder);
    outcome["title"] = planned.rig.title;
    outcome["povray_version"] = povray.version;
    outcome["jobs"] = jobs;
    outcome["frames_rendered"] = result.rendered;
    outcome["frames_kept"] = result.kept;
    outcome["povray_s"] = frames.povray_s;
    if (planned.plan.scene.user_scene) outcome["probe_s"] = planned.probe_s;
    if (options.json) {
        fmt::print("{}\n", dumped(outcome));
        return kDone;
    }
    fmt::print("POV-Ray {}: {} rendered, {} kept, in {:.1f} s with {}{}\n",
               povray.version,
               counted(result.rendered, "frame"),
               result.kept,
               frames.povray_s,
               counted(static_cast<std::size_t>(jobs), "job"),
               planned.plan.scene.user_scene
                   ? fmt::format(", after a {:.1f} s scene probe", planned.probe_s)
                   : "");
    print_outcome(outcome);
    return kDone;
}

}  // namespace

Action configure_render(CLI::App& app) {
    constexpr int kMostJobs = 1024;
    const auto options = std::make_shared<RenderCommandOptions>();
    add_planning_options(app, options->planning);
    app.add_option("-o,--output", options->folder, "the folder to write to")
        ->required()
        ->type_name("DIR");
    app.add_option("--jobs", options->jobs, "frames at a time; by default the cores")
        ->check(in_range(1, kMostJobs))
        ->capture_default_str();
    add_preview_options(app, options->preview);
    add_needs_option(app, options->planning.ignore_needs);
    app.add_flag("--json", options->json, "say what was done as JSON");
    return [options] { return render_rig(*options); };
}

}  // namespace aphotic::cli
