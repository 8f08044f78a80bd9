// SPDX-License-Identifier: BSD-3-Clause
//
// Runs POV-Ray on a set of scenes with a progress line, and takes the time. The options' report is
// the line.
#pragma once

#include "plugin/render.h"

#include <filesystem>

namespace aphotic::cli {

struct RenderedFrames {
    RenderResult result;
    double povray_s = 0.0;
};

[[nodiscard]] RenderedFrames render_frames(const PovRay& povray,
                                           const std::filesystem::path& folder,
                                           const SceneSet& scenes,
                                           RunOptions options);

}  // namespace aphotic::cli
