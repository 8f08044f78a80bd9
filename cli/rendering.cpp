// SPDX-License-Identifier: BSD-3-Clause
#include "cli/rendering.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/words.h"

#include <fmt/format.h>

#include <chrono>

namespace aphotic::cli {

PovRay povray_for(const PlannedRender& planned,
                  const PlanningOptions& options,
                  const std::string& folder) {
    try {
        return find_povray(options.povray);
    } catch (const RunError& error) {
        if (planned.plan.scene.user_scene) throw;
        throw RunError(
            "{}. Without POV-Ray, `aphotic trace {} -o {}` makes the same images, by the reference",
            error.what(),
            shell_word(options.rig_file),
            shell_word(folder));
    }
}

RenderedFrames render_frames(const PovRay& povray,
                             const std::filesystem::path& folder,
                             const SceneSet& scenes,
                             RunOptions options) {
    const auto start = std::chrono::steady_clock::now();
    RenderedFrames frames;
    ProgressLine line;
    options.report = [&](const FrameProgress& progress) {
        line.show(fmt::format("rendering: {} of {} frames", progress.frames_done, progress.frames),
                  progress.share);
    };
    frames.result = render(povray, folder, scenes, options);
    frames.povray_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return frames;
}

}  // namespace aphotic::cli
