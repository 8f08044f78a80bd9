// SPDX-License-Identifier: BSD-3-Clause
//
// A beam's intensity over blocks of directions: what rig/beam/beam.h says of one, at the camera's
// pace.
//
//   I |V| = intensity * reach        V  a direction in the lamp's frame, of any length
//
// by rig/beam/beam.h's own formulas; no kind of beam is resampled over directions, so kinks stay
// where they are. What is smooth along a row and costs much (powers, angles, a window's factor) is
// computed at some pixels and fitted in between, where that is right to 1e-8 (row_fit.h), else
// everywhere. Cones and optics have
// I/cos(theta) for their intensity and V.a for their reach (a: the axis, theta: off it), which
// needs no root; tables I and |V|. Behind a window it is the direction in air that counts,
//
//   V_air = (n V_x, n V_y, sqrt(|V|^2 - n^2 (V_x^2 + V_y^2))),   as long as V
//
// and intensity has the window's factor.
//
// On which side of a beam's edge a direction is, and whether a window lets it out, may be taken
// from the directions that were asked for before, as though those of now had no edge: a ray that
// dispersion turns a little keeps its side (continued_intensity() of rig/beam/beam.h).
//
// A further kind is a file beside lobe_light.h, table_light.h and optics_light.h.
#pragma once

#include "lightmap/lobe_light.h"
#include "lightmap/optics_light.h"
#include "lightmap/table_light.h"
#include "rig/beam/beam.h"

#include <optional>
#include <variant>

namespace aphotic {

struct BeamLight {
    std::variant<LobeLight, TableLight, OpticsLight> kind;
    std::optional<BeamWindow> window;
    bool is_round = true;  // the same all about the axis: asks for no V.along and V.across
};

// Of a beam times a factor.
[[nodiscard]] BeamLight beam_light(const Beam& beam, double factor);
// The frame in which the directions of this beam are: turned by turn_rad.
[[nodiscard]] BeamFrame turned_frame(const Beam& beam, const Eigen::Vector3d& axis);

struct BeamBlock {
    RowBlock<double> intensity;
    const RowBlock<double>* reach = nullptr;  // of this block, or of the directions
    LobeWork lobes;
    TableWork table;
    OpticsWork optics;
    DirectionBlock in_air;
    RowBlock<double> window_factor;
    RowBlock<double> is_let_out;  // 1 or 0
};

void look_into(const BeamLight& light, const DirectionBlock& V, Edges edges, BeamBlock& block);

}  // namespace aphotic
