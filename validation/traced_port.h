// SPDX-License-Identifier: BSD-3-Clause
//
// The reference's own port: the path of a ray from the pupil, for the numbers of rig/camera/port.h,
// whose formulas it does not use.
//
// Flat: n times the unit direction's components across the normal is the same in every medium.
// Dome: n times the ray's distance from the dome's centre is constant (Bouguer). In the plane of
// ray and centre, angles are measured from the point of the ray in air that is nearest to the
// centre, at distance b, with i = asin(b / (n r)) on either side of a face of radius r: the ray
// meets a face at (its direction's angle) - i, and leaves it along that place's angle + i'.
#pragma once

#include "rig/camera/port.h"

#include <Eigen/Core>

namespace aphotic {

struct TracedRay {
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
    Eigen::Matrix<long double, 3, 1> direction;  // of any length
};

// in_air: of any length, z above 0. Indices are relative to air.
[[nodiscard]] TracedRay through_port(const PortWindow& port,
                                     const Eigen::Matrix<long double, 3, 1>& in_air,
                                     double glass_index,
                                     double water_index);

}  // namespace aphotic
