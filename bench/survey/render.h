// SPDX-License-Identifier: BSD-3-Clause
//
// The images of a survey, by POV-Ray: frames of one plan for all of them.
//
// `aphotic generate` plans once, over all the paths that a survey can have, and writes one scene a
// frame. What differs from image to image stands before it, in a copy of its own: the number, the
// pose and the kind of floor, with all their digits. So an image costs its frames and nothing else;
// `aphotic render` on each would look at the scene eight times before it.
#pragma once

#include "bench/survey/flight.h"
#include "plugin/frame_runner.h"
#include "plugin/povray.h"
#include "spectral/manifest.h"

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::survey {

// What an image shows: see Survey_Floor in scenes/survey/survey.pov.
struct Picture {
    Leg leg;
    std::string floor;            // natural, chart or card
    std::filesystem::path image;  // where the camera's signal goes: float R, G, B
};

// The generated scene of a frame, for one picture.
[[nodiscard]] std::string scene_of(const std::string& generated, const Picture& picture);

// Renders and integrates those whose image is not there yet; an image that stands is whole. Frames
// are removed when their image is made. folder: of `aphotic generate`.
void render_pictures(const PovRay& povray,
                     const std::filesystem::path& folder,
                     const std::vector<Picture>& pictures,
                     const RunOptions& options);

}  // namespace aphotic::survey
