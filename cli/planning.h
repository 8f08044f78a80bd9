// SPDX-License-Identifier: BSD-3-Clause
//
// A rig, its plan and its scenes, the same for every command that plans a render.
#pragma once

#include "cli/options.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"

namespace aphotic::cli {

struct PlannedRender {
    Rig rig;
    RenderPlan plan;
    double probe_s = 0.0;  // that the probe of the user's own scene took
};

// Reads the rig, surveys the user's own scene where there is one, and plans. Messages name the
// rig's file.
[[nodiscard]] PlannedRender plan_rig(const PlanningOptions& options);

// The scenes of the plan.
[[nodiscard]] SceneSet scenes_of(const PlannedRender& planned, const PlanningOptions& options);

}  // namespace aphotic::cli
