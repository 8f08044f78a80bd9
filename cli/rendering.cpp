// SPDX-License-Identifier: BSD-3-Clause
#include "cli/rendering.h"

#include "cli/progress.h"

#include <fmt/format.h>

#include <chrono>

namespace aphotic::cli {

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
