// SPDX-License-Identifier: BSD-3-Clause
//
// Writes a rig as POV-Ray scenes, one per frame, that plain `povray` renders.
//
// A frame carries up to three wavelengths, one in each of the image's channels red, green and blue,
// which POV-Ray never mixes. A pixel of the frame holds, in lambda's channel, the radiance
// L(lambda) of docs/background/physics.md times 2^e, the frame's exposure (exposure.h). If a beam
// needs a filter shell (beam_sdl.h), the scene's unit is so small that shells, a thousandth of it
// in size, shadow no pixel.
//
// Behind a port a frame is rendered with the refractive indices of one wavelength
// (render_plan.h).
//
// Parts that a rig lacks are not in its scenes (light_culling.h): no media in clear water, no port,
// no cone of weight or power 0 or that lights nothing in view, no highlight of strength 0.
//
// A scene defines the contents of the water; water, strobes, camera and port come from the macros
// of plugin/include/aphotic.inc (include_library.h), which read the frame's band (band_sdl.h). That
// holds for a rig's floor and for a user's scene alike.
#pragma once

#include "image/frame_format.h"
#include "rig/geometry.h"
#include "rig/rig.h"
#include "scene_gen/exposure.h"
#include "scene_gen/povray_veil.h"
#include "scene_gen/user_scene.h"
#include "spectral/planned_wavelength.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// The default of SceneOptions::pixel_shift [px].
inline constexpr double kPixelShift = 0.25;

struct FrameScene {
    std::string name;  // such as band_478_576_638nm
    std::string sdl;
};

// A ray is no longer followed once it contributes at most a thousandth of the allowed error.
inline constexpr double kRayShare = 0x1p-10;
inline constexpr double kTargetError = 1e-3;

struct SceneOptions {
    int wavelengths_per_frame = 3;          // 1 to 3
    double pixel_shift = kPixelShift;       // the largest shift in a shared frame behind a port
    std::optional<LampGrid> emitter_lamps;  // empty: lamp_grid() chooses per strobe
    bool omit = true;             // false: parts that change nothing are written all the same
    int peak_log2 = kTargetLog2;  // level of a frame's brightest pixel, or slightly above it
    FrameFormat format = FrameFormat::Exr;
    std::shared_ptr<const UserScene> user_scene{};  // empty: the rig's own floor
    // The share of a pixel's light below which rays between a user's mirrors and glasses end.
    double bailout = kRayShare * kTargetError;
    // In water that scatters: POV-Ray renders the veil, with this number of samples per ray. Empty:
    // light/veil.h.
    std::optional<int> veil_samples{};
    std::optional<PovrayVeil> povray_veil{};  // as planned
    int antialias = 0;           // n x n rays per pixel, besides the one through its centre
    std::string declarations{};  // in POV-Ray's language, ahead of everything else
    // Lines for POV-Ray's INI file: keys that change its speed but no pixel, and a scene's clock.
    std::vector<std::string> ini_lines{};
};

// The fog distance of the frame that shows, by a fog, the distance that each pixel sees
// (spectral/manifest.h), in water that scatters over anything but the rig's bare floor, unless
// POV-Ray renders the veil; else 0. It is large enough that the fog is about proportional to the
// distance, which then has a half float's precision; for a PNG, whose steps are even, it is the
// farthest distance in view.
[[nodiscard]] double fog_m(const Rig& rig, const SceneOptions& options);

// The lamps of each strobe's emitter at these wavelengths, by strobe of the rig.
[[nodiscard]] std::vector<LampGrid> scene_lamps(const Rig& rig,
                                                std::span<const PlannedWavelength> wavelengths,
                                                const SceneOptions& options);

// The scenes of all frames: those of the direct light, then by lobe those of a veil that POV-Ray
// renders, and for a user's scene those of its light without the water's scattering, to be
// subtracted. Or the scene of fog. Sets the exposure of each wavelength. Throws InputError if a
// strobe is at an impossible place (at or below the floor, inside the camera's housing), if POV-Ray
// cannot find a port's surfaces, or if there are more lights than POV-Ray's limit in water.
[[nodiscard]] std::vector<FrameScene> make_scenes(const Rig& rig,
                                                  std::span<const LampGrid> lamps,
                                                  const SceneOptions& options,
                                                  std::span<PlannedWavelength> wavelengths);

// Metres in one unit of the rig's scene: 1, or the power of two at or below the least relevant
// distance (lamp to lit surface, pupil to the floor, the largest side of an object) if that is
// below kLeastInMetres_m; and below a thousand times a port's glass and its distance from the
// pupil. POV-Ray's tolerances are fixed numbers of units: for instance, it ignores light within
// 1e-3 of a lamp and shadows from within 1e-3.
[[nodiscard]] double scene_unit_m(const Rig& rig);
inline constexpr double kLeastInMetres_m = 0x1p-6;

// POV-Ray fails inside a medium with more lights than this.
inline constexpr int kMostLightsInMedia = 1024;

// A frame of the probe (plugin/probe.h): everything white, all lamps equal.
struct ProbeFrame {
    Channels attenuation_per_m{};
    int exposure_log2 = 0;
    Channels strobes{1.0, 1.0, 1.0};      // their brightness in each channel
    int only_strobe = 0;                  // counted from 1; 0: all
    bool is_coarse_in_radiosity = false;  // minimal radiosity, if the scene has any
    bool dims_lamps = true;               // false: the water attenuates only the camera's leg
};
[[nodiscard]] std::string probe_sdl(const Rig& rig,
                                    const std::string& scene_name,
                                    const ProbeFrame& frame);

// A frame that shows the distance that each pixel of the image sees in a user's scene: without
// light or textures, a fog leaves 1 - exp(-D / fog_m) in red and 0 in green and blue, with D the
// ray's path in water. Light in green or blue is emitted by the scene. The rays are the lens's, at
// the middle of the camera's range.
[[nodiscard]] std::string distance_sdl(const Rig& rig,
                                       const std::string& scene_name,
                                       const std::string& declarations,
                                       double fog_m);

// The settings with which every scene of the rig is rendered, as a POV-Ray INI file.
[[nodiscard]] std::string render_ini(const Rig& rig, const SceneOptions& options = {});

}  // namespace aphotic
