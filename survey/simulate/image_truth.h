// SPDX-License-Identifier: BSD-3-Clause
//
// The content of each pixel of a simulated survey, in addition to its image:
//
//   depth/000001.exr         float Z: along the camera's axis, from the pupil [m]
//   normals/000001.exr       float N.X, N.Y, N.Z: unit, towards the camera, X right, Y down, Z
//                            along the axis
//   reflectance/000001.exr   float R, G, B: the share of the lamps' light, without water, that the
//                            surface there returns to each channel
//
//   rho_c = int sum_s P_s Phi_s rho Q_c dlambda / int sum_s P_s Phi_s Q_c dlambda    times T(x, y)
//
// P Phi  a lamp's flux     rho  the surface's diffuse reflectance   Q_c  the camera's response
// T      the floor's texture, if it has one (simulated_survey.h)
//
// NaN where nothing is in view. Each is for the ray through the pixel's centre.
#pragma once

#include "survey/simulate/simulated_survey.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <optional>

namespace aphotic {

struct SeenPoint {
    Eigen::Vector3d point_m;  // in the sled's frame
    Eigen::Vector3d normal;   // unit, towards the camera
    std::size_t surface = 0;  // the floor, then the rig's objects in their order
};

// For one pose, from several threads: the surface at the point (column, row) of the image.
using Sight = std::function<std::optional<SeenPoint>(double column, double row)>;

// Writes what survey.truth requests and does not exist yet, for rigs with a floor and objects.
void write_seen(const SimulatedSurvey& survey, const std::function<Sight(const Sled&)>& sight_at);

}  // namespace aphotic
