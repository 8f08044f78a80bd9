// SPDX-License-Identifier: BSD-3-Clause
//
// The options that choose the wavelengths and how they share frames, the same for every command
// that plans a render.
#pragma once

#include "scene_gen/scene_set.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace aphotic::cli {

struct PlanningOptions {
    std::string rig_file;
    int bands = 36;
    std::vector<double> wavelengths_nm;
    int per_frame = 3;
    std::vector<int> emitter_lamps;
};

// The rig and its wavelengths.
void add_wavelength_options(CLI::App& app, PlanningOptions& options);

// These, and how POV-Ray is to render them.
void add_planning_options(CLI::App& app, PlanningOptions& options);

struct PlannedWavelengths {
    Rig rig;
    std::vector<WeightedWavelength> wavelengths;
};

[[nodiscard]] PlannedWavelengths plan_wavelengths(const PlanningOptions& options);

struct PlannedRender {
    Rig rig;
    SceneSet scenes;
};

[[nodiscard]] PlannedRender plan_render(const PlanningOptions& options);

}  // namespace aphotic::cli
