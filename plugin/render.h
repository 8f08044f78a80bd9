// SPDX-License-Identifier: BSD-3-Clause
//
// Renders a set of scenes into a folder, and continues where an earlier run stopped.
//
// A frame of an earlier run is kept if its scene and settings are identical to the bit, the same
// version of POV-Ray rendered it, and its image is complete and the one recorded; all others are
// rendered. File times are ignored. The manifest is rewritten after each frame, so that an
// interruption costs only the unfinished frames.
//
// Other frames of an earlier run, and images made from them, are removed: they could not be reused,
// but could be mistaken for this rig's. So are the reference tracer's images.
//
// If a user's scene is edited during the render, the render ends: no frame of the edited scene is
// recorded, and those recorded before belong to the old scene, so the next run renders them again.
#pragma once

#include "base/work_folder.h"
#include "plugin/frame_runner.h"
#include "plugin/povray.h"
#include "scene_gen/scene_set.h"

#include <cstddef>
#include <filesystem>

namespace aphotic {

struct RenderResult {
    Manifest manifest;  // with every frame done
    std::size_t rendered = 0;
    std::size_t kept = 0;
};

// An unreadable manifest in the folder is an InputError, and no file is changed: it might be
// another program's, or record hours of frames.
RenderResult render(const PovRay& povray,
                    const std::filesystem::path& folder,
                    const SceneSet& set,
                    const RunOptions& options);

// A share (base/work_folder.h) of the frames of a folder whose scenes exist, from render() or
// generate(): into its own folder, without images. Frames that the folder already has are not
// rendered again. The folder itself is only read: for a user's scene, options name the includes.
RenderResult render_share(const PovRay& povray,
                          const std::filesystem::path& folder,
                          WorkShare share,
                          const RunOptions& options);

// Moves the frames that shares left below the folder, if they are of its scenes, into it and its
// manifest; render() also does this. Returns their number. An InputError if frames are from
// different versions of POV-Ray.
std::size_t join_frames(const std::filesystem::path& folder);

// Writes scenes and manifest without rendering. Images of earlier scenes, and the reference
// tracer's, are removed, so that they cannot be mistaken for images of these.
Manifest generate(const std::filesystem::path& folder, const SceneSet& set, int threads = 1);

}  // namespace aphotic
