// SPDX-License-Identifier: BSD-3-Clause
//
// Finds POV-Ray, runs it on a set of scenes with a progress line, and takes the time. The options'
// report is the line.
#pragma once

#include "cli/planning.h"
#include "plugin/render.h"

#include <filesystem>
#include <string>

namespace aphotic::cli {

// The POV-Ray that the options name. Where there is none that serves, the message also says what
// makes the same images without it: not of a scene of the user's own, which the tracer cannot read.
[[nodiscard]] PovRay povray_for(const PlannedRender& planned,
                                const PlanningOptions& options,
                                const std::string& folder);

struct RenderedFrames {
    RenderResult result;
    double povray_s = 0.0;
};

[[nodiscard]] RenderedFrames render_frames(const PovRay& povray,
                                           const std::filesystem::path& folder,
                                           const SceneSet& scenes,
                                           RunOptions options);

}  // namespace aphotic::cli
