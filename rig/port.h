// SPDX-License-Identifier: BSD-3-Clause
//
// The window that a camera looks through, and what it does to a ray.
//
// Flat: air inside, glass, water outside, both faces perpendicular to the camera's axis, z. A ray
// obeys Snell at both,
//
//   sin(air) = n_glass sin(glass) = n_water sin(water)
//
// with both indices relative to air, at the ray's wavelength.
//
// Who needs a port's rays asks here. Four know its kind besides: the rig's reader; scene_gen/ for
// POV-Ray, which traces the block of glass itself; lightmap/row_light.h, whose inner loop has the
// formula; and the reference (validation/).
#pragma once

#include "spectral/refractive_index.h"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace aphotic {

struct FlatPort {
    double distance_m = 0.0;  // pupil to the inner face
    double thickness_m = 0.0;
    Glass glass;
};

using Port = std::optional<FlatPort>;  // none: the pupil is in the water

// Where light enters the water on its way to a pixel, reversed: origin and unit direction.
struct WaterRay {
    Eigen::Vector3d origin_m;
    Eigen::Vector3d direction;
};

// What becomes of the ray that leaves the pupil along the unit vector in_air.
[[nodiscard]] WaterRay ray_into_water(const Port& port,
                                      const Eigen::Vector3d& in_air,
                                      double lambda_nm,
                                      double water_index);

// From the pupil to the water, along the axis [m].
[[nodiscard]] double front_m(const Port& port);

// Steps in which the image's rim is followed for the longest of its rays: where rays bend, all
// along it, else from corner to corner.
[[nodiscard]] int steps_along_rim(const Port& port);

// Ports of the same signature bend all rays alike.
[[nodiscard]] std::string port_signature(const FlatPort& port);

}  // namespace aphotic
