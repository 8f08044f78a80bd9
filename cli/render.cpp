// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic render RIG -o DIR: the main job, from a rig file to a camera image through POV-Ray.
#include "plugin/render.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/terminal.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct RenderCommandOptions {
    PlanningOptions planning;
    std::string folder;
    int jobs = all_cores();
    PreviewOptions preview;
    WorkShare share{};
    bool is_share = false;
    bool json = false;
};

struct Rendered {
    std::optional<Integration> integration{};  // none of a share
    fs::path folder;
    std::string povray_version;
    int jobs = 1;
    RenderedFrames frames;
    std::optional<double> probe_s{};  // of the user's scene
};

nlohmann::ordered_json to_json(const Rendered& rendered) {
    const auto& [result, povray_s] = rendered.frames;
    nlohmann::ordered_json json;
    if (rendered.integration)
        json = to_json(*rendered.integration);
    else
        json["folder"] = rendered.folder.string();
    json["povray_version"] = rendered.povray_version;
    if (rendered.integration) json["jobs"] = rendered.jobs;
    json["frames_rendered"] = result.rendered;
    json["frames_kept"] = result.kept;
    json["povray_s"] = povray_s;
    if (rendered.probe_s) json["probe_s"] = *rendered.probe_s;
    return json;
}

void print(const Rendered& rendered) {
    const auto& [result, povray_s] = rendered.frames;
    say("POV-Ray {}: {} rendered, {} kept, in {:.1f} s",
        rendered.povray_version,
        counted(result.rendered, "frame"),
        result.kept,
        povray_s);
    if (!rendered.integration) {
        say("\n  {}: join the shares by `aphotic integrate`\n", rendered.folder.string());
        return;
    }
    say(" with {}{}\n",
        counted(static_cast<std::size_t>(rendered.jobs), "job"),
        rendered.probe_s ? fmt::format(", after a {:.1f} s scene probe", *rendered.probe_s) : "");
    print(*rendered.integration);
}

ExitStatus render_frames_of_share(const RenderCommandOptions& options) {
    const fs::path folder = options.planning.rig_file;
    if (!fs::exists(manifest_path(folder)))
        throw InputError(
            "{}: found no manifest.json; allowed with --frames: a folder of `aphotic "
            "generate`",
            folder.string());
    const PovRay povray = find_povray(options.planning.povray);
    const fs::path own = share_folder(folder, options.share);
    const ResourceNeeds needs = needs_of_share(folder, options.share, options.jobs);
    require_room(needs, own, options.planning.ignore_needs);
    std::optional<FolderLock> whole;
    if (!options.share.is_whole()) whole.emplace(folder, FolderUse::Read);
    const FolderLock lock = claim_folder(own);
    const int jobs = jobs_that_fit(needs, options.jobs);
    show(Rendered{.folder = own,
                  .povray_version = povray.version,
                  .frames = render_frames(run_options(options.planning, jobs),
                                          [&](const RunOptions& run) {
                                              return render_share(
                                                  povray, folder, options.share, run);
                                          })},
         options.json);
    return kDone;
}

// A share uses the existing scenes: planning options do not apply.
void refuse_what_plans(const CLI::App& app) {
    constexpr std::string_view kOfShares =
        "RIG,--frames,--jobs,--json,--povray,--stall-timeout,--library-path,--ignore-needs";
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name(false, false);
        if (option->count() == 0 || std::ranges::count(comma_fields(kOfShares), name) > 0) continue;
        throw InputError("{}: found with --frames; allowed: with a rig", name);
    }
}

ExitStatus render_rig(const RenderCommandOptions& options) {
    const PlannedRender planned = plan_rig(options.planning);
    const SceneSet scenes = scenes_of(planned, options.planning);
    const PovRay povray = povray_for(planned, options.planning, options.folder);
    const int jobs =
        require_place_and_room(scenes, options.folder, options.jobs, options.planning.ignore_needs);

    const FolderLock lock = claim_folder(options.folder);
    Rendered rendered{
        .folder = options.folder,
        .povray_version = povray.version,
        .jobs = scenes.user_scene.writes_files ? 1 : jobs,
        .frames = render_frames(run_options(options.planning, jobs), [&](const RunOptions& run) {
            return render(povray, options.folder, scenes, run);
        })};
    rendered.integration = integrate_folder(
        options.folder, rendered.frames.result.manifest, options.preview, options.folder);
    if (planned.plan.scene.user_scene) rendered.probe_s = planned.probe_s;
    show(rendered, options.json);
    return kDone;
}

}  // namespace

Action configure_render(CLI::App& app) {
    const auto options = std::make_shared<RenderCommandOptions>();
    add_output_folder(app, options->folder);
    add_jobs(app, options->jobs);
    add_needs_option(app, options->planning.ignore_needs);
    add_json(app, options->json);
    add_planning_options(app, options->planning);
    add_preview_options(app, options->preview);
    add_share(app, "--frames", options->share)->each([options](const std::string&) {
        options->is_share = true;
    });
    return [options, &app] {
        if (options->is_share) {
            refuse_what_plans(app);
            return render_frames_of_share(*options);
        }
        if (options->folder.empty())
            throw InputError("--output: is missing; only --frames does without");
        return render_rig(*options);
    };
}

}  // namespace aphotic::cli
