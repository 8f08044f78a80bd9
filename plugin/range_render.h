// SPDX-License-Identifier: BSD-3-Clause
//
// How far each pixel sees in a scene of the user's own, of the images of a simulated survey, by one
// run of POV-Ray each, which asks no texture of the scene's:
//
//   red = 1 - exp(-D / f),   Z = o_z + D w_z
//
// D     the way in water of the ray through the pixel's centre, up to what it meets [m]
// f     distance of a fog that is white in red and black in green and blue: the altitude [m]
// o, w  where that ray enters the water, and its unit direction there (rig/geometry.h), at the
//       middle of the camera's range: behind a port there is no fog, for no water is there
// Z     along the camera's axis from the pupil [m]
//
// A 16-bit PNG rounds red to q = 2^-17, so that D is off by at most q f exp(D / f): 2.1e-5
// altitudes at one altitude, 5.6e-5 at two. From kFarthestFogs f on, where that is 0.3 % of D, it
// is unknown. Half floats would round forty times as coarsely. What shines by itself shows in green
// and blue, and is an InputError.
//
// Of a mirror or a glass, D is none that any ray goes: red is then the sum of what shows, each by
// its share.
#pragma once

#include "plugin/frame_runner.h"
#include "plugin/survey_render.h"
#include "rig/rig.h"

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kFarthestFogs = 8.0;

struct RangeRender {
    Rig rig;
    std::filesystem::path scene;  // of the user's own
    std::vector<std::string> declared{};
    std::vector<std::string> ini_lines{};  // settings of the scene's, such as its clock
};

// Of those whose `image` is not there yet, that: one float channel Z, NaN where it is unknown.
// folder: of the scenes.
void render_ranges(const PovRay& povray,
                   const std::filesystem::path& folder,
                   const RangeRender& render,
                   const std::vector<SurveyPicture>& pictures,
                   const RunOptions& options);

}  // namespace aphotic
