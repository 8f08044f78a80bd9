// SPDX-License-Identifier: BSD-3-Clause
//
// Runs POV-Ray on the scenes of a folder, several at a time.
//
// POV-Ray runs inside DIR/povray, so that its file restrictions never apply, or in the folder of
// the user's scene, so that it finds the scene's includes, with our render.ini as its only settings
// file. Each frame is rendered under a temporary name, checked (image/frame_check.h) and then
// renamed. POV-Ray's messages go to DIR/povray/logs/NAME.log.
//
// Frames are files, not an animation of one scene: a process costs 0.45 s more than another frame
// of an animation, half of it asleep, compared with seconds for a frame of useful size; and a
// single scene can be read, rendered again, and sent elsewhere.
#pragma once

#include "plugin/povray.h"
#include "scene_gen/user_scene.h"
#include "spectral/integrator.h"
#include "spectral/manifest.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace aphotic {

struct FrameProgress {
    std::size_t frames = 0;
    std::size_t frames_done = 0;
    double share = 0.0;  // of all the work, 0 to 1
};

struct RunOptions {
    // The number of frames at a time, and threads for each, so that together they use this many
    // cores.
    int jobs = 1;
    std::function<void(const FrameProgress&)> report{};
    // Called with each image before it is checked: for scenes whose settings request another format
    // than EXR, makes the EXR from the file next to it.
    std::function<void(const ManifestFrame&, const std::filesystem::path& image)> convert{};
    // A user's scene: POV-Ray runs in its folder, with its include paths besides the user's own
    // library_paths; one at a time, with all threads, if it may read files that it writes.
    SceneFile scene{};
    std::vector<std::string> library_paths{};
    double stall_s = kStall_s;
    // Called for each frame, in the order in which they end: when its image is complete, before it
    // is renamed, so that every renamed image has been recorded, however the process ends; and
    // after it is renamed.
    std::function<void(const ManifestFrame&, const std::filesystem::path& image)> checked{};
    std::function<void(const ManifestFrame&)> arrived{};
};

// Renders the frames. If one fails, the others are stopped, and a RunError quotes POV-Ray; an
// interruption throws Interrupted (base/interruption.h), and a scene that was edited meanwhile a
// RunError, since a frame of it may show either version. None leaves files of unfinished frames.
// Images do not depend on jobs.
void run_frames(const PovRay& povray,
                const std::filesystem::path& folder,
                const std::vector<ManifestFrame>& frames,
                int width_px,
                int height_px,
                const RunOptions& options);

}  // namespace aphotic
