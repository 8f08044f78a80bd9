// SPDX-License-Identifier: BSD-3-Clause
//
// The options that choose the wavelengths and how they share frames, the same for every command
// that plans a render.
#pragma once

#include "plugin/povray.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace aphotic::cli {

struct PlanningOptions {
    std::string rig_file;
    double tolerance = 1e-3;
    int fitted = 0;  // 0: as the tolerance asks
    int bands = 0;   // 0: fitted wavelengths
    std::vector<double> wavelengths_nm;
    std::vector<double> paths_m;
    int per_frame = 3;
    double pixel_shift = kPixelShift;
    std::vector<int> emitter_lamps;
    bool renders = false;  // otherwise a scene that the rig names is left alone
    std::string scene;
    std::vector<std::string> library_paths;
    bool unchecked = false;
    double clock = 0.0;
    int antialias = 0;
    std::vector<std::string> povray_ini;
    std::string povray;
    bool ignore_needs = false;
    double stall_timeout_s = kStall_s;
};

// Which POV-Ray, and how long it may be silent.
void add_povray_options(CLI::App& app, std::string& povray, double& stall_timeout_s);

// The rig and its wavelengths, without POV-Ray.
void add_wavelength_options(CLI::App& app, PlanningOptions& options);

// These, and how POV-Ray is to render them.
void add_planning_options(CLI::App& app, PlanningOptions& options);

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
