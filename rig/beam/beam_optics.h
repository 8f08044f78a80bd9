// SPDX-License-Identifier: BSD-3-Clause
//
// The beam of a lit rectangle behind a thin lens, in closed form:
//
//   I(w) = cos(theta) Area{ x in the lens : |x (1 - s/f) - s m| within the rectangle }   [m^2]
//
//   m       (tan along, tan across) of the direction w, m = 0 on the axis
//   s, f    rectangle to lens, and focal length [m]
//   lens    a disc of radius R = aperture/2 about the axis
//
// per unit of the rectangle's radiance, which is uniform and isotropic. Light that leaves the lens
// at x with slope m comes from the point x (1 - s/f) - s m of the rectangle, so the area is that of
// the disc within a rectangle: half sides those of the diffuser over |1 - s/f|, middle s m / (1 -
// s/f).
//
//   s = f        a sharp image of the rectangle, cut at the slopes u/f: I has steps there
//   s otherwise  the image is blurred by the lens: I falls smoothly
//
// The flux is the integral over the lens of the light that each point receives from the rectangle,
// which has a closed form (Lambert's for a rectangle).
//
// Limits: a thin lens without aberration or loss, geometrical optics; no light beyond 90 degrees.
#pragma once

#include <Eigen/Core>

namespace aphotic {

struct BeamOptics {
    double along_m = 0.0;  // sides of the diffuser
    double across_m = 0.0;
    double focal_length_m = 0.0;
    double distance_m = 0.0;  // diffuser to lens
    double aperture_m = 0.0;  // diameter

    [[nodiscard]] bool operator==(const BeamOptics&) const = default;
};

// Directions are in the lamp's frame: x along, y across, z the axis, of any length but 0.

[[nodiscard]] double optics_intensity(const BeamOptics& optics, const Eigen::Vector3d& direction);
// The same for an unbounded rectangle: the value on the near side of a sharp image's edge.
[[nodiscard]] double endless_intensity(const BeamOptics& optics, const Eigen::Vector3d& direction);

// Upper bound of I over all directions within an angle of this one, and over all directions.
[[nodiscard]] double most_optics_intensity(const BeamOptics& optics,
                                           const Eigen::Vector3d& direction,
                                           double within_rad);
[[nodiscard]] double most_optics_intensity(const BeamOptics& optics);

// The integral of I over all directions [m^2 sr].
[[nodiscard]] double optics_flux(const BeamOptics& optics);

// The diffuser is in the lens's focal plane: the image has an edge, and a direction is within it.
[[nodiscard]] bool is_focused(const BeamOptics& optics);
[[nodiscard]] bool is_within_image(const BeamOptics& optics, const Eigen::Vector3d& direction);

}  // namespace aphotic
