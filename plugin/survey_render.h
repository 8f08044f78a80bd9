// SPDX-License-Identifier: BSD-3-Clause
//
// The images of a simulated survey, by POV-Ray: frames of one plan for all of them, with the scene
// of each at its own pose. So an image costs its frames and nothing else; `aphotic render` on each
// would look at a user's scene many times before it.
//
// A user's scene places itself under the sled. Before it stands what differs from image to image,
// with all digits:
//
//   Survey_Image      from 1 on          Survey_Pitch   degrees, bow up
//   Survey_Seed       of 31 bits         Survey_Roll    degrees, starboard down
//   Survey_Altitude   metres, along the camera's axis
//
// and what the caller declares besides. The rig's own floor and objects need none of this.
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
    int number = 0;  // no other has it
    std::uint32_t seed = 0;
    Sled sled{};
    std::filesystem::path image{};  // where the camera's signal goes: float R, G, B
};

// Declarations in POV-Ray's language, of the picture and of these, such as Floor="card".
[[nodiscard]] std::string declarations(const SurveyPicture& picture,
                                       const std::vector<std::string>& declared);

// Of these the numbers, as POV-Ray's settings take them, NAME=NUMBER: for the probe of a scene.
[[nodiscard]] std::vector<std::string> declared_numbers(const SurveyPicture& picture,
                                                        const std::vector<std::string>& declared);

// "Floor=\"card\"" or "Depth = 2"; an InputError else.
void require_declaration(const std::string& declared);

// That light goes to what any of these sleds sees of the rig's floor and objects. A user's scene
// may stand kRelief nearer.
[[nodiscard]] PathRange paths_of_poses(Rig rig, const std::vector<Sled>& sleds, bool has_scene);
inline constexpr double kRelief = 0.9;

struct SurveyRender {
    Rig rig;
    RenderPlan plan;  // serves the paths of all poses
    std::vector<std::string> declared{};
};

// Renders and integrates those whose image is not there yet; an image that stands is whole. Frames
// are removed when their image is made. folder: of the scenes.
void render_pictures(const PovRay& povray,
                     const std::filesystem::path& folder,
                     const SurveyRender& render,
                     const std::vector<SurveyPicture>& pictures,
                     const RunOptions& options);

}  // namespace aphotic
