// SPDX-License-Identifier: BSD-3-Clause
//
// Figures of the quality of an image's light, for comparing designs.
//
//   evenness        U0 = least / mean      of the floor's light over the image; called overall
//                                          uniformity in lighting standards (CIE, IES)
//   diversity       Ud = least / most      the same, against the brightest pixel
//   coverage        share of the pixels whose floor light is at least `level` of the brightest's
//   signal to noise least of g / sqrt(g + v)
//
// g  the floor's light at a pixel as the camera receives it, vignetting included
// v  the veil's: light that the water scatters into the view
//
// The noise is only that of photons, whose variance is their number; the veil adds noise and no
// information, so the ratio scales with the root of the light. It is in units of the root of the
// signal's, and meaningful only relative to another of the same camera. Read noise is omitted.
//
// For an image, each figure is that of its worst channel. A channel without any light is ignored;
// if none has any, all figures are 0. In even light U0, Ud and coverage are 1. Under one isotropic
// lamp beside the pupil at height h in clear water, light falls as cos^3(theta): Ud is cos^3 of the
// corners'.
#pragma once

#include "lightmap/lightmap.h"

#include <span>

namespace aphotic {

struct LightFigures {
    double evenness = 0.0;
    double diversity = 0.0;
    double coverage = 0.0;
    double signal_to_noise = 0.0;
};

// The worse of each.
[[nodiscard]] LightFigures worst_of(const LightFigures& a, const LightFigures& b);

// For one channel. veil: empty, or as many as the floor's.
[[nodiscard]] LightFigures figures_of_plane(std::span<const float> floor,
                                            std::span<const float> veil,
                                            double level);

[[nodiscard]] LightFigures figures_of(const Lightmap& map, double level);

}  // namespace aphotic
