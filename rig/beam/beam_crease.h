// SPDX-License-Identifier: BSD-3-Clause
//
// Steps and kinks of a beam's intensity, as surfaces of unit directions w, and their crossings with
// a great circle.
//
//   l.w = at                       a circle about l: a cone's edge, both ends of a soft one, a row
//                                  of a table; with at = 0 a plane: a column
//   w.Q w = at                     a plane or circle seen through a window; a corner of the
//                                  rectangle behind a lens
//   w(phi) = e cos(phi) + u sin(phi)        e and u unit vectors, one across the other
//
// On the circle the first is A cos(phi) + B sin(phi) = at, with A = l.e and B = l.u; the second is
// the same in 2 phi. Both have solutions in closed form. Between neighbouring crossings I is
// analytic, with one exception: the corners of a blurred rectangle behind a window, where the slope
// of I is continuous and its curvature steps, are omitted.
#pragma once

#include "rig/beam/beam.h"

#include <Eigen/Core>

#include <vector>

namespace aphotic {

struct Crease {
    Eigen::Vector3d l = Eigen::Vector3d::Zero();
    Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
    double at = 0.0;
    bool is_quadratic = false;  // given by Q, else by l
};

// A surface may extend beyond the crease itself, to where I is smooth.
[[nodiscard]] std::vector<Crease> creases_of(const Beam& beam, const BeamFrame& frame);

// Adds each phi of a crossing, from -pi to pi.
void add_crossings(const Crease& crease,
                   const Eigen::Vector3d& e,
                   const Eigen::Vector3d& u,
                   std::vector<double>& phi_rad);

}  // namespace aphotic
