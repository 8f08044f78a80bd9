// SPDX-License-Identifier: BSD-3-Clause
//
// The window that a camera looks through, and its effect on a ray: air inside, glass, water
// outside. At both faces a ray obeys Snell's law, with the face's normal m where it passes and the
// ratio e of the index before it to that behind,
//
//   d' = e d + (sqrt(1 - e^2 (1 - c^2)) - e c) m,      c = d . m
//
// with both indices relative to air, at the ray's wavelength.
//
// Flat: both faces are perpendicular to one normal, for most ports the camera's axis, z, where
//
//   sin(air) = n_glass sin(glass) = n_water sin(water)
//
// Dome: both faces are spheres about one centre. With the centre at the pupil no ray is bent.
//
// Callers use these rays and do not know the port. The exceptions are the rig's reader, and
// scene_gen/ for POV-Ray, which traces the glass itself. The reference has its own ports
// (validation/).
#pragma once

#include "spectral/refractive_index.h"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace aphotic {

struct Dome {
    Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  // the pupil is the origin
    double radius_m = 0.0;                               // of the inner face

    bool operator==(const Dome&) const = default;
};

struct PortWindow {
    double distance_m = 0.0;  // of a flat port: pupil to inner face, along the normal
    double thickness_m = 0.0;
    Glass glass;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of a flat port: unit, into the water
    std::optional<Dome> dome{};                         // empty for a flat port
};

using Port = std::optional<PortWindow>;  // empty: the pupil is in the water

// The path of a pixel's light in the water, reversed: origin at the port and unit direction.
struct WaterRay {
    Eigen::Vector3d origin_m;
    Eigen::Vector3d direction;
};

// The ray that leaves the pupil along the unit vector in_air, after the port. An InputError if it
// misses the port.
[[nodiscard]] WaterRay ray_into_water(const Port& port,
                                      const Eigen::Vector3d& in_air,
                                      double lambda_nm,
                                      double water_index);

// Whether the port is flat and perpendicular to the camera's axis.
[[nodiscard]] bool is_across_axis(const PortWindow& port);

// From the pupil to the water, along the axis [m].
[[nodiscard]] double front_m(const Port& port);

// Ports of the same signature bend all rays alike.
[[nodiscard]] std::string port_signature(const PortWindow& port);

}  // namespace aphotic
