// SPDX-License-Identifier: BSD-3-Clause
//
// Renders a set of scenes into a folder, and goes on where an earlier run stopped.
//
// A frame of an earlier run is kept when its scene and settings are the same to the bit, the
// same version of POV-Ray made it, and its image is the one that was noted and whole; all others
// are rendered. Times of files count for nothing. The manifest is written anew after each frame, so
// that whatever interrupts a render costs the frames under way and nothing else.
//
// What an earlier run left of other frames, and images made from them, is taken away: it could
// not be used again, only be mistaken for this rig's. So are the reference tracer's images.
//
// A user's scene that is edited meanwhile ends the render: no frame of the edited one is noted, and
// those noted before belong to the scene as it was, so the next run renders them again.
#pragma once

#include "base/work_folder.h"
#include "plugin/frame_runner.h"
#include "plugin/povray.h"
#include "scene_gen/scene_set.h"

#include <cstddef>
#include <filesystem>

namespace aphotic {

struct RenderResult {
    Manifest manifest;  // every frame done
    std::size_t rendered = 0;
    std::size_t kept = 0;
};

// A manifest of the folder that cannot be read is an InputError, and nothing is touched: it might
// be another program's, or note hours of frames.
RenderResult render(const PovRay& povray,
                    const std::filesystem::path& folder,
                    const SceneSet& set,
                    const RunOptions& options);

// A share (base/work_folder.h) of the frames of a folder whose scenes are there, by render() or
// generate(): into its own folder, and no image is made of them. Frames that the folder has stay
// there. The folder itself is only read: of a scene of the user's own, options name the includes.
RenderResult render_share(const PovRay& povray,
                          const std::filesystem::path& folder,
                          WorkShare share,
                          const RunOptions& options);

// Takes the frames that shares left below the folder, where they are of its scenes, into it and its
// manifest; render() does so by itself. Returns how many. An InputError where other frames are of
// another version of POV-Ray.
std::size_t join_frames(const std::filesystem::path& folder);

// Writes scenes and manifest without rendering. Images of earlier scenes, and the reference
// tracer's, are taken away, so that they cannot be taken for images of these.
Manifest generate(const std::filesystem::path& folder, const SceneSet& set, int threads = 1);

}  // namespace aphotic
