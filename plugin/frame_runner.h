// SPDX-License-Identifier: BSD-3-Clause
//
// Runs POV-Ray on the scenes of a folder, several at a time.
//
// POV-Ray runs inside DIR/povray, so that its restrictions on files never bite, or in the folder of
// the user's own scene, so that it finds what that includes; with our render.ini as its only
// settings file. Each frame is rendered beside its place, checked (image/frame_check.h) and then
// renamed into it. POV-Ray's own words go to DIR/povray/logs/NAME.log.
//
// Frames are files, not an animation of one scene: a process costs 0.45 s more than a further
// frame of an animation, half of it asleep, against seconds for a frame of useful size; and a
// scene by itself can be read, rendered again, and sent elsewhere.
#pragma once

#include "plugin/povray.h"
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
    // Frames at a time; the threads of each, so that they use as many cores together.
    int jobs = 1;
    std::function<void(const FrameProgress&)> report{};
    // Called with each image before it is checked: for scenes whose settings ask POV-Ray for
    // another format than EXR, makes the EXR of what stands beside it.
    std::function<void(const ManifestFrame&, const std::filesystem::path& image)> convert{};
    // For a scene of the user's own: its folder, in which POV-Ray runs, and where it looks for
    // includes beside the user's own library_paths.
    std::filesystem::path scene_folder{};
    bool one_at_a_time = false;  // with all threads: a scene that reads what it writes
    std::vector<std::string> library_paths{};
    double stall_s = kStall_s;
    // Called for each frame, in the order in which they end: with its image when that is whole,
    // before it takes its place, so that what stands there has been noted, however we end; and when
    // it is there.
    std::function<void(const ManifestFrame&, const std::filesystem::path& image)> checked{};
    std::function<void(const ManifestFrame&)> arrived{};
};

// Renders the frames. When one fails the others are stopped, and a RunError quotes POV-Ray; when we
// are interrupted, Interrupted comes (base/interruption.h). Neither leaves anything of the frames
// that were under way. Images do not depend on jobs.
void run_frames(const PovRay& povray,
                const std::filesystem::path& folder,
                const std::vector<ManifestFrame>& frames,
                int width_px,
                int height_px,
                const RunOptions& options);

}  // namespace aphotic
