// SPDX-License-Identifier: BSD-3-Clause
//
// Examines a user's scene before it is planned, by running POV-Ray on it at a small size: first
// unchanged, to find the spectra that it requests from aphotic.inc and, from POV-Ray's own
// statistics, whether it has radiosity, photons or media; then once for each strobe, to measure the
// paths and brightness of its light.
//
// In such a frame everything is white, all lamps are equal, and the three channels have the
// absorption K / 1024, K and -K. For a pixel that a strobe lights over a path l,
//
//   red = G exp(-K l / 1024),   green = G exp(-K l),   blue = G exp(K l),
//   l = ln(blue / green) / (2 K)
//
// exact for light that a surface reflects once; for several paths at once (mirrors, an emitter's
// lamps) it is a mean of them. Where blue is infinite, as over a mirror's endless path into the
// void, l = ln(red / green) / (K - K / 1024). A pixel out of the half floats' range is measured
// again, with other light or loss.
//
// The first frame is without water, so that any medium in it is the scene's own and channels differ
// only by colours given as numbers. One more frame detects conditions for which no plan is
// possible: light with all strobes off, a camera in an object without water.
//
// A scene that writes files may read them back, so only one POV-Ray runs on it at a time.
#pragma once

#include "plugin/povray.h"
#include "scene_gen/user_scene.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aphotic {

struct ProbeOptions {
    int jobs = 1;
    std::vector<std::string> library_paths;  // besides the user's own
    std::function<void(double)> progress{};  // share of the work
    double stall_s = kStall_s;
    std::vector<std::string> ini_lines{};  // settings of POV-Ray's for the scene, such as its clock
    bool unchecked = false;  // radiosity, photons and media void the promise and are not refused
};

// Pixels of the probe along the longer side of the image.
inline constexpr int kProbePixels = 160;

// Throws InputError, with the reason, for a scene that cannot be rendered spectrally: without our
// water or camera, with lights that are not strobes of aphotic.inc, a lamp that the rig does not
// have, a spectrum that is not found, without any lit surface; with radiosity, photons or its own
// media, unless unchecked. Errors of POV-Ray's parser are passed on with file and line. A scene
// that changes in the meantime is a RunError.
[[nodiscard]] UserScene probe_scene(const PovRay& povray,
                                    const Rig& rig,
                                    const std::filesystem::path& scene_file,
                                    const ProbeOptions& options);

}  // namespace aphotic
