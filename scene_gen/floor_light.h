// SPDX-License-Identifier: BSD-3-Clause
//
// What one strobe does to the point of the floor that a ray shows, without wavelength:
//
//   L = Phi (rho diffuse + specular) exp(-K path)
//
//   diffuse   = power I cos(i) / (pi d^2)                        [1/m^2]
//   specular  = power I phong max(0, m.l)^size / (pi d^2)
//   path      = d + r                                            [m]
//
// with the letters of docs/physics.md and I the beam's intensity (rig/beam/beam.h). The strobe is a
// point.
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"

namespace aphotic {

struct FloorLight {
    double diffuse_per_m2 = 0.0;
    double specular_per_m2 = 0.0;
    double path_m = 0.0;
};

// By what lights the point lobes_at_m, carried on: rays that differ by a port's dispersion alone
// keep to the same side of the beam's edges. Nothing when the ray shows no floor; dark when the
// strobe does not light it.
[[nodiscard]] std::optional<FloorLight> floor_light(const Rig& rig,
                                                    const Strobe& strobe,
                                                    const WaterRay& ray,
                                                    const Eigen::Vector3d& lobes_at_m);

}  // namespace aphotic
