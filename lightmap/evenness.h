// SPDX-License-Identifier: BSD-3-Clause
//
// The quality of an image's light, in figures that a designer can compare.
//
//   evenness        U0 = least / mean      of the floor's light over the image; what lighting
//                                          standards call overall uniformity (CIE, IES)
//   diversity       Ud = least / most      the same, against the brightest pixel
//   coverage        share of the pixels whose floor's light is at least `level` of the brightest's
//   signal to noise least of g / sqrt(g + v)
//
// g  the floor's light at a pixel, vignetting included: what the camera gets of it
// v  the veil's: what the water scatters into the view
//
// The noise is only the photons', whose variance is their number; veil adds noise and no
// information, so the ratio goes with the root of the light. It is in units of the root of the
// signal's, and meaningful only relative to another of the same camera. Read noise is omitted.
//
// For an image: the worst of its channels. A channel that sees no light at all is ignored; if none
// sees any, all figures are 0. In even light U0, Ud and coverage are 1. Under one isotropic lamp
// beside the pupil at height h in clear water, light falls as cos^3(theta): Ud is cos^3 of the
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
