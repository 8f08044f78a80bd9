// SPDX-License-Identifier: BSD-3-Clause
//
// A rig, its plan, its scenes and its frames, the same for every command that plans a render.
#pragma once

#include "cli/model_error.h"
#include "cli/options.h"
#include "plugin/render.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aphotic::cli {

struct PlannedRender {
    Rig rig;
    RenderPlan plan;
    double probe_s = 0.0;                  // of the probe of the user's scene
    std::optional<ManifestModel> model{};  // of water that scatters
};

// Reads the rig, probes the user's scene if there is one, plans, and estimates the model error.
// Messages name the rig's file.
[[nodiscard]] PlannedRender plan_rig(const PlanningOptions& options);

[[nodiscard]] SceneSet scenes_of(const PlannedRender& planned, const PlanningOptions& options);

// The POV-Ray named by the options. If none works, the message also names the command that makes
// the same images without it, except for a user's scene, which the tracer cannot read.
[[nodiscard]] PovRay povray_for(const PlannedRender& planned,
                                const PlanningOptions& options,
                                const std::string& folder);

// POV-Ray settings for a user's scene: its clock.
[[nodiscard]] std::vector<std::string> scene_ini(const PlanningOptions& options);

[[nodiscard]] RunOptions run_options(const PlanningOptions& options, int jobs);

struct RenderedFrames {
    RenderResult result;
    double povray_s = 0.0;
};

// Runs POV-Ray by the call, with a line of progress, the options' report, and measures the time.
using RenderCall = std::function<RenderResult(const RunOptions&)>;
[[nodiscard]] RenderedFrames render_frames(RunOptions options, const RenderCall& render);

}  // namespace aphotic::cli
