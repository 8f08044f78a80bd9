// SPDX-License-Identifier: BSD-3-Clause
//
// A plan to look at: the light that each material can send, by its shortest and its longest path,
// with the wavelengths marked; and below it the error of each channel over path length, of the
// material on which it is largest.
#pragma once

#include "scene_gen/render_plan.h"

#include <filesystem>

namespace aphotic::cli {

void plot_plan(const Rig& rig, const RenderPlan& plan, const std::filesystem::path& file);

}  // namespace aphotic::cli
