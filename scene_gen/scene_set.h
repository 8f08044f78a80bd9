// SPDX-License-Identifier: BSD-3-Clause
//
// Everything for a render of a rig before POV-Ray runs: the scenes, and the manifest, which
// determines the images from their frames. Written to a folder DIR:
//
//   DIR/manifest.json
//   DIR/povray/render.ini, DIR/povray/band_*.pov, DIR/povray/*.inc, DIR/povray/frames/
#pragma once

#include "rig/rig.h"
#include "scene_gen/pov_scene.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/user_scene.h"
#include "spectral/bands.h"
#include "spectral/manifest.h"

#include <array>
#include <filesystem>
#include <span>
#include <vector>

namespace aphotic {

struct SceneSet {
    std::vector<FrameScene> scenes;   // in the order of manifest.frames
    Manifest manifest;                // nothing rendered yet
    std::string ini;                  // without paths, which affect no pixel
    std::optional<Camera> camera{};   // with a lens, whose rays are written; empty: a pinhole
    std::vector<float> vignetting{};  // by pixel; empty without vignetting
    // The rig whose veil is written next to the frames; null: none, or POV-Ray renders it.
    std::optional<Rig> scattering{};
    SceneFile user_scene{};  // as planned
};

// Throws InputError if a wavelength counts whose light is fainter than frames can represent.
[[nodiscard]] SceneSet make_scene_set(const Rig& rig, const RenderPlan& plan);

// Light fainter than frames can represent. POV-Ray's colours are floats, which bounds exposures,
// and the sample of L(lambda_j) in a frame is at most
//
//   2^e_j B_j        B_j  the bound of L(lambda_j)       e_j  the exposure
//
// Below 2^-14 half floats lose digits. If all light is so faint, the image is black, as it should
// be. If such a wavelength counts beside others that are represented, by |w_cj| B_j relative to the
// channel's largest, the loss has no bound.
//
// Throws InputError if a wavelength counts whose light is not represented. Wavelengths below
// frame_error of the largest do not count. The same holds for PNG frames, below 2^-6.
void require_light_that_counts(std::span<const PlannedWavelength> wavelengths,
                               double frame_error,
                               FrameFormat format = FrameFormat::Exr);

// The signal of the lamps themselves: the sum over strobes of their light, unattenuated and white,
// over the full spectrum.
[[nodiscard]] std::array<double, kChannels> lamp_signal(const Rig& rig, const LightFamily& family);

// Throws InputError if POV-Ray could not read its settings in the folder, which need not exist yet.
void require_place_for_scenes(const std::filesystem::path& folder, const SceneSet& set);

// Scenes, settings and an empty folder for the frames; not the manifest, in which the first render
// records the existing frames.
void write_scenes(const std::filesystem::path& folder, const SceneSet& set);

}  // namespace aphotic
