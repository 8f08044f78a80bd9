// SPDX-License-Identifier: BSD-3-Clause
//
// The plan of a render: its wavelengths, weights and frames, the omitted parts, and the promised
// error.
//
// The promise of a channel is
//
//   promise = error + amplification frame_error
//
// (spectral/quadrature_fit.h). frame_error is kFrameError, and kLampError more if point lamps
// represent an emitter. It holds for every pixel off the edges of beams and objects that is
// brighter than black (1e-8 of the brightest), relative to its own signal. A user's scene may
// contain something that voids it, which no_promise names.
//
// For a veil rendered by POV-Ray, the promise is measured and may exceed the tolerance, to which
// only the direct light is planned (scene_gen/povray_veil.h). Where objects or a user's scene may
// cast shadows in it, it has none.
#pragma once

#include "scene_gen/light_culling.h"
#include "scene_gen/light_paths.h"
#include "scene_gen/pov_scene.h"
#include "spectral/quadrature_fit.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace aphotic {

// The lamps of an emitter err by 1e-4 (geometry.h), the reference's by a fifth of that.
inline constexpr double kLampError = 1.2e-4;

// What may be requested.
inline constexpr int kMostFitted = 48;
inline constexpr int kMostBands = 100'000;
inline constexpr double kLeastPath_m = 1e-6;
inline constexpr double kMostPath_m = 1e6;

struct PlanRequest {
    double tolerance = 1e-3;             // the fewest fitted wavelengths that achieve it
    std::optional<int> fitted;           // or this number, whatever their error
    std::optional<int> bands;            // or equal bands
    std::vector<double> wavelengths_nm;  // or these, with fitted weights
    std::optional<PathRange> paths;      // instead of those of the rig's own camera
    SceneOptions scene;
};

// How the wavelengths were chosen.
enum class PlanMethod { Fitted, EqualBands, Listed };

struct RenderPlan {
    PlanMethod method = PlanMethod::Fitted;
    double tolerance = 0.0;  // 0: none was requested
    LightFamily family;
    std::vector<PlannedWavelength> wavelengths{};  // increasing; not exposed yet
    std::array<RuleQuality, kChannels> quality{};
    double frame_error = 0.0;
    double veil_error = 0.0;  // of the veil of scattering water; part of quality's
    SceneOptions scene;       // including the veil that POV-Ray renders, if requested
    std::vector<Omission> omissions;
    std::vector<std::string> no_promise{};  // reasons against a promise; empty: it has one

    [[nodiscard]] std::size_t frames() const {
        return wavelengths.empty() ? 0 : wavelengths.back().frame + 1;
    }
    [[nodiscard]] double error() const { return worst_error(quality); }
    [[nodiscard]] double promise() const { return worst_promise(quality, frame_error); }
};

[[nodiscard]] double frame_error(const Rig& rig);

// Throws InputError if the tolerance cannot be achieved, or wavelengths are out of order or range.
// If sharing frames behind a port would exceed the tolerance, each wavelength has its own.
[[nodiscard]] RenderPlan plan_render(const Rig& rig, const PlanRequest& request);

// Distributes increasing wavelengths over frames, with the light of the rig or of its user's scene,
// without weights yet. Behind a dispersing port those of a frame must be nearly equal, since it has
// one set of refractive indices: neighbours share one if the first and the last are shifted against
// each other by no more than options.pixel_shift (light/dispersion.h), and it is rendered at the
// wavelength halfway.
[[nodiscard]] std::vector<PlannedWavelength> in_frames(const Rig& rig,
                                                       std::span<const double> lambda_nm,
                                                       const SceneOptions& options);

// The light in each wavelength's frame, for the fitter's family.
[[nodiscard]] std::vector<FrameLight> frames_light(const QuadratureFitter& fitter,
                                                   std::span<const PlannedWavelength> wavelengths);

void take_weights(const FittedRule& rule, std::span<PlannedWavelength> wavelengths);

}  // namespace aphotic
