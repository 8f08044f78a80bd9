// SPDX-License-Identifier: BSD-3-Clause
//
// What a lens makes of a diffuser over blocks of directions (beam_light.h): the closed form of
// rig/beam/beam_optics.h,
//
//   I/cos(theta) = Area{ x in the lens : |x (1 - s/f) - s m| within the rectangle }
//
// of the disc of radius 1 within a rectangle, all cases at once.
#pragma once

#include "lightmap/direction_block.h"
#include "rig/beam/beam_optics.h"

namespace aphotic {

struct OpticsLight {
    bool is_focused = false;
    // Sides of the rectangle in the lens are (+-half - shift slope), in its radii; of a sharp image
    // the slopes at its edges.
    double half_along = 0.0;
    double half_across = 0.0;
    double shift = 0.0;
    double per_area = 0.0;  // I/cos(theta) by the area on the disc of radius 1
};
[[nodiscard]] OpticsLight optics_light(const BeamOptics& optics, double factor);

// Lines x = t of the disc, -1 <= t <= 1, and the area on their near side.
struct DiscLines {
    RowBlock<double> t;
    RowBlock<double> area;
};

struct OpticsWork {
    RowBlock<double> x;  // of the rectangle's middle
    RowBlock<double> y;
    DiscLines x0;
    DiscLines x1;
    DiscLines y0;
    DiscLines y1;
    RowBlock<double> is_within;  // the sharp image: 1 or 0
};

void look_into(const OpticsLight& light,
               const DirectionBlock& V,
               Edges edges,
               OpticsWork& work,
               RowBlock<double>& intensity);

}  // namespace aphotic
