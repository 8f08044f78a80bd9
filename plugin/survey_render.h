// SPDX-License-Identifier: BSD-3-Clause
//
// The images of a simulated survey, by POV-Ray: one plan for all frames, and the scene of each
// image at its own pose. An image thus costs only its frames; separate runs of `aphotic render`
// would probe a user's scene many times.
//
// A user's scene places itself below the sled. It is preceded by the values that differ from image
// to image, with all digits:
//
//   Survey_Image      counted from 1     Survey_Pitch   degrees, bow up
//   Survey_Seed       of 31 bits         Survey_Roll    degrees, starboard down
//   Survey_Altitude   metres, along the camera's axis
//
// and by the caller's declarations. The rig's own floor and objects need none of this.
#pragma once

#include "plugin/frame_runner.h"
#include "plugin/povray.h"
#include "rig/rig.h"
#include "scene_gen/render_plan.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

struct SurveyPicture {
    int number = 0;  // unique
    std::uint32_t seed = 0;
    Sled sled{};
    std::filesystem::path image{};  // the file of the camera's signal: float R, G, B
};

// Declarations in POV-Ray's language, of the picture's values and of these, such as Floor="card".
[[nodiscard]] std::string declarations(const SurveyPicture& picture,
                                       const std::vector<std::string>& declared);

// The numbers among these, in the form of POV-Ray's settings, NAME=NUMBER: for the probe of a
// scene.
[[nodiscard]] std::vector<std::string> declared_numbers(const SurveyPicture& picture,
                                                        const std::vector<std::string>& declared);

// From "Floor=\"card\"" or "Depth = 2"; otherwise an InputError.
void require_declaration(const std::string& declared);

// The paths of light to the parts of the rig's floor and objects that any of these sleds sees. A
// user's scene may be kRelief closer.
[[nodiscard]] PathRange paths_of_poses(Rig rig, const std::vector<Sled>& sleds, bool has_scene);
inline constexpr double kRelief = 0.9;

struct SurveyRender {
    Rig rig;
    RenderPlan plan;  // for the paths of all poses
    std::vector<std::string> declared{};
};

// Renders and integrates those whose image does not exist yet; an existing image is complete.
// Frames are removed when their image is complete. folder: for the scenes.
void render_pictures(const PovRay& povray,
                     const std::filesystem::path& folder,
                     const SurveyRender& render,
                     const std::vector<SurveyPicture>& pictures,
                     const RunOptions& options);

}  // namespace aphotic
