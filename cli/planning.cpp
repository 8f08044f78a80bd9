// SPDX-License-Identifier: BSD-3-Clause
#include "cli/planning.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "base/words.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "plugin/probe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <memory>
#include <utility>

namespace aphotic::cli {
namespace {

// POV-Ray settings that change only its speed. Others would change a frame's contents: Quality
// below 9 omits the water; gamma and format are fixed by the integrator.
constexpr std::string_view kSpeedKeys =
    "Bounding, Bounding_Method, Bounding_Threshold, BSP_BaseAccessCost, BSP_ChildAccessCost, "
    "BSP_IsectCost, BSP_MaxDepth, BSP_MissChance, Light_Buffer, Remove_Bounds, Render_Block_Size, "
    "Split_Unions, Vista_Buffer";

std::string ini_line(const std::string& setting) {
    const std::size_t sign = setting.find('=');
    const std::string key = setting.substr(0, sign);
    const bool is_plain = sign != std::string::npos &&
                          std::ranges::all_of(setting.substr(sign + 1), [](unsigned char c) {
                              return std::isalnum(c) != 0 || c == '.' || c == '-';
                          });
    if (!is_plain || std::ranges::count(comma_fields(kSpeedKeys), key) == 0) {
        throw InputError(
            "--povray-ini: found {}; allowed: KEY=VALUE with one of {}. Others would change the "
            "image; for antialiasing there is --antialias",
            setting,
            kSpeedKeys);
    }
    return setting + "\n";
}

PlanRequest request_of(const PlanningOptions& options) {
    PlanRequest request = options.plan;
    if (options.veil == "povray") request.scene.veil_samples = options.veil_samples;
    for (const std::string& setting : options.povray_ini) {
        request.scene.ini_lines.push_back(ini_line(setting));
    }
    std::ranges::copy(scene_ini(options), std::back_inserter(request.scene.ini_lines));
    if (!options.paths_m.empty())
        request.paths = {.shortest_m = options.paths_m[0], .longest_m = options.paths_m[1]};
    if (!options.emitter_lamps.empty()) {
        request.scene.emitter_lamps = {.across = options.emitter_lamps[0],
                                       .along = options.emitter_lamps[1]};
    }
    return request;
}

std::shared_ptr<const UserScene> probed(const Rig& rig, const PlanningOptions& options) {
    const std::filesystem::path scene =
        options.scene.empty() ? rig.scene : std::filesystem::path(options.scene);
    if (!options.renders || scene.empty()) {
        if (options.clock == 0.0) return nullptr;
        throw InputError(
            "--clock: found {} without a scene; allowed: with one of your own, by --scene or the "
            "rig's `scene`",
            options.clock);
    }
    std::vector<std::string> ini_lines = scene_ini(options);
    for (const std::string& number : options.declared)
        ini_lines.push_back("Declare=" + number + "\n");
    ProgressLine line;
    auto probed_scene = std::make_shared<const UserScene>(
        probe_scene(find_povray(options.povray),
                    rig,
                    scene,
                    {.jobs = all_cores(),
                     .library_paths = options.library_paths,
                     .progress = [&](double share) { line.show("probing the scene", share); },
                     .stall_s = options.stall_timeout_s,
                     .ini_lines = std::move(ini_lines),
                     .unchecked = options.unchecked}));
    for (const std::string& reason : probed_scene->no_promise) {
        warn("{}: no promise: {}", scene.string(), reason);
    }
    return probed_scene;
}

}  // namespace

PlannedRender plan_rig(const PlanningOptions& options) {
    Rig rig = read_rig_as_set(options.rig_file);
    if (options.sled) {
        rig.sled = *options.sled;
    } else {
        check_plausible(rig, options.rig_file, options.strict);
    }
    PlanRequest request = request_of(options);
    const Stopwatch watch;
    request.scene.user_scene = probed(rig, options);
    const double probe_s = watch.seconds();
    RenderPlan plan = [&] {
        ProgressLine line;
        line.show("planning", 0.0);
        return naming(options.rig_file, [&] { return plan_render(rig, request); });
    }();
    const auto model = model_error(rig, options.rig_file, options.model_tolerance);
    return {.rig = std::move(rig), .plan = std::move(plan), .probe_s = probe_s, .model = model};
}

SceneSet scenes_of(const PlannedRender& planned, const PlanningOptions& options) {
    SceneSet scenes =
        naming(options.rig_file, [&] { return make_scene_set(planned.rig, planned.plan); });
    scenes.manifest.model = planned.model;
    scenes.manifest.rig_settings = rig_settings();
    return scenes;
}

PovRay povray_for(const PlannedRender& planned,
                  const PlanningOptions& options,
                  const std::string& folder) {
    try {
        PovRay povray = find_povray(options.povray);
        require_format(povray, options.plan.scene.format);
        return povray;
    } catch (const RunError& error) {
        if (planned.plan.scene.user_scene) throw;
        throw RunError(
            "{}. Without POV-Ray, `aphotic trace {} -o {}` makes the same images, by the reference",
            error.what(),
            shell_word(options.rig_file),
            shell_word(folder));
    }
}

std::vector<std::string> scene_ini(const PlanningOptions& options) {
    if (options.clock == 0.0) return {};
    return {fmt::format("; The scene's own.\nClock={}\n", options.clock)};
}

RunOptions run_options(const PlanningOptions& options, int jobs) {
    return {
        .jobs = jobs, .library_paths = options.library_paths, .stall_s = options.stall_timeout_s};
}

RenderedFrames render_frames(RunOptions options, const RenderCall& render) {
    const Stopwatch watch;
    ProgressLine line;
    options.report = [&line](const FrameProgress& progress) {
        line.show(fmt::format("rendering: {} of {} frames", progress.frames_done, progress.frames),
                  progress.share);
    };
    RenderResult result = render(options);
    return {.result = std::move(result), .povray_s = watch.seconds()};
}

}  // namespace aphotic::cli
