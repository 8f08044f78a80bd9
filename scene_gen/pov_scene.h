// SPDX-License-Identifier: BSD-3-Clause
//
// Writes a rig as POV-Ray scenes, one a frame, that plain `povray` renders.
//
// A frame carries up to three wavelengths, one in each of the image's channels red, green and
// blue: POV-Ray never mixes them. A pixel of the frame is, in the channel of lambda, the radiance
// L(lambda) of docs/background/physics.md times 2^e, the frame's exposure (exposure.h). Where a
// beam takes a filter shell (beam_sdl.h), the scene's unit is so small that shells, a thousandth of
// it in size, shadow no pixel.
//
// Behind a port a frame is rendered with the refractive indices of one wavelength
// (frame_groups.h).
//
// What a rig does not hold is not in its scenes (light_culling.h): no media in clear water, no
// port, no cone of weight or power 0 or that lights nothing in view, no highlight of strength 0.
//
// A scene says what stands in the water; water, strobes, camera and port come to it through the
// macros of plugin/include/aphotic.inc (include_library.h), fed with the frame's band (band_sdl.h).
// That holds for a rig's floor and for a scene of the user's own alike.
#pragma once

#include "image/frame_format.h"
#include "rig/geometry.h"
#include "rig/rig.h"
#include "scene_gen/exposure.h"
#include "scene_gen/frame_groups.h"
#include "scene_gen/povray_veil.h"
#include "scene_gen/user_scene.h"
#include "spectral/planned_wavelength.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

struct FrameScene {
    std::string name;  // such as band_478_576_638nm
    std::string sdl;
};

// A ray that is not followed counts for a thousandth of the error that is allowed, by then.
inline constexpr double kRayShare = 0x1p-10;
inline constexpr double kTargetError = 1e-3;

struct SceneOptions {
    int wavelengths_per_frame = 3;          // 1 to 3
    double pixel_shift = kPixelShift;       // how far a shared frame may shift one behind a port
    std::optional<LampGrid> emitter_lamps;  // none: lamp_grid() chooses per strobe
    bool omit = true;                       // false: what changes nothing is written all the same
    int peak_log2 = kTargetLog2;            // where a frame's brightest pixel goes, or a bit under
    FrameFormat format = FrameFormat::Exr;
    std::shared_ptr<const UserScene> user_scene{};  // none: the rig's own floor
    // The share of a pixel's light under which rays between a user's mirrors and glasses end.
    double bailout = kRayShare * kTargetError;
    // In water that scatters: POV-Ray makes the veil, of so many samples a ray. None: light/veil.h.
    std::optional<int> veil_samples{};
    std::optional<PovrayVeil> povray_veil{};  // as the plan has it
    int antialias = 0;  // n x n rays to a pixel, beside the one through its centre
    // Lines for POV-Ray's INI file: of keys that change how fast it is and no pixel, and a scene's
    // clock.
    std::vector<std::string> ini_lines{};
};

// Of the frame that tells how far each pixel sees, by a fog (spectral/manifest.h), in water
// that scatters over anything but the rig's bare floor, unless POV-Ray makes the veil; else 0. So
// large that the fog is about proportional to the distance, whose digits are a half float's; for a
// PNG, whose steps are even, as large as what is in view is far.
[[nodiscard]] double fog_m(const Rig& rig, const SceneOptions& options);

// By strobe of the rig, the lamps that stand for its emitter at these wavelengths.
[[nodiscard]] std::vector<LampGrid> scene_lamps(const Rig& rig,
                                                std::span<const PlannedWavelength> wavelengths,
                                                const SceneOptions& options);

// The scene of each frame: those of the direct light, then by lobe those of a veil that POV-Ray
// makes, and of a user's scene what shines in them without the water's, to be taken off. Or the one
// of fog. Sets how each of the wavelengths is exposed. Throws InputError when a
// strobe stands where it cannot light from (at or under the floor, inside the camera's housing),
// when POV-Ray cannot find a port's surfaces, or when there are more lights than it takes in water.
[[nodiscard]] std::vector<FrameScene> make_scenes(const Rig& rig,
                                                  std::span<const LampGrid> lamps,
                                                  const SceneOptions& options,
                                                  std::span<PlannedWavelength> wavelengths);

// Metres in one unit of the rig's scene: 1, or the power of two at or under the least distance that
// counts (lamp to what it lights, pupil to the floor, the largest side of an object) where that is
// under kLeastInMetres_m; and under a thousand times a port's glass and its distance from the
// pupil. POV-Ray's tolerances are fixed numbers of its units: it takes no light from the last 1e-3
// before a lamp and passes over what shades from within 1e-3, for instance.
[[nodiscard]] double scene_unit_m(const Rig& rig);
inline constexpr double kLeastInMetres_m = 0x1p-6;

// POV-Ray gives up inside a medium when it meets more lights than this.
inline constexpr int kMostLightsInMedia = 1024;

// A frame by which a scene is measured (plugin/probe.h): everything white, all lamps alike.
struct SurveyFrame {
    Channels attenuation_per_m{};
    int exposure_log2 = 0;
    Channels strobes{1.0, 1.0, 1.0};      // their brightness in each channel
    int only_strobe = 0;                  // counted from 1; 0: all
    bool is_coarse_in_radiosity = false;  // of a scene that has it: next to none
    bool dims_lamps = true;               // false: the water dims the camera's leg alone
};
[[nodiscard]] std::string survey_sdl(const Rig& rig,
                                     const std::string& scene_name,
                                     const SurveyFrame& frame);

// A frame that tells how far each pixel of the image sees in a user's scene: nothing shines, no
// texture is asked, and a fog leaves 1 - exp(-D / fog_m) in red and nothing in green and blue, D
// being the ray's way in water. What green or blue hold shines of itself. The rays are the lens's,
// at the middle of the camera's range.
[[nodiscard]] std::string distance_sdl(const Rig& rig,
                                       const std::string& scene_name,
                                       const std::string& declarations,
                                       double fog_m);

// The settings under which every scene of the rig renders, as a POV-Ray INI file.
[[nodiscard]] std::string render_ini(const Rig& rig, const SceneOptions& options = {});

}  // namespace aphotic
