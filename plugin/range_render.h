// SPDX-License-Identifier: BSD-3-Clause
//
// The distance that each pixel of a simulated survey's images sees in a user's scene, by one
// POV-Ray run per image, which evaluates none of the scene's textures:
//
//   red = 1 - exp(-D / f),   Z = o_z + D w_z
//
// D     the way in water of the ray through the pixel's centre, up to a surface [m]
// f     distance of a fog that is white in red and black in green and blue: the altitude [m]
// o, w  where that ray enters the water, and its unit direction there (rig/geometry.h), at the
//       middle of the camera's range: inside a port there is no water, and so no fog
// Z     along the camera's axis from the pupil [m]
//
// A 16-bit PNG rounds red to q = 2^-17, so the error of D is at most q f exp(D / f): 2.1e-5
// altitudes at one altitude, 5.6e-5 at two. From kFarthestFogs f on, where that is 0.3 % of D, it
// is unknown. Half floats would round forty times as coarsely. Objects that emit light are visible
// in green and blue, and are an InputError.
//
// For a mirror or glass, D is no ray's length: red is then a weighted sum over its rays.
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
    std::filesystem::path scene;  // the user's
    std::vector<std::string> declared{};
    std::vector<std::string> ini_lines{};  // settings for the scene, such as its clock
};

// Renders those whose `image` does not exist yet: one float channel Z, NaN where it is unknown.
// folder: for the scenes.
void render_ranges(const PovRay& povray,
                   const std::filesystem::path& folder,
                   const RangeRender& render,
                   const std::vector<SurveyPicture>& pictures,
                   const RunOptions& options);

}  // namespace aphotic
