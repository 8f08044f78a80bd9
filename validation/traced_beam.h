// SPDX-License-Identifier: BSD-3-Clause
//
// A beam in the reference, from the rig's description (the structs of rig/beam/beam.h), without any
// function of rig/.
//
//   I(w)   intensity in the direction w of the sled's frame, per unit of the lamp's power  [1/sr]
//
//   cones    sum of A_k cos^n S. A soft edge is a mean of sharp ones: S is the share, by the
//            density 6 t (1 - t) over t in 0 to 1, of those that end beyond w, with the cosines of
//            their edges from cos(gamma) at t = 0 to cos(gamma - edge) at t = 1. So the flux of
//            cos^n S is the same mean of that of sharp cones, 2 pi (1 - cos^(n + 1)) / (n + 1)
//   table    bilinear in the two angles, 0 beyond them; its flux cell by cell, by Gauss-Legendre
//   optics   cos(theta) times the area of the lens from which rays in the direction w, followed
//            back through the lens, come from the rectangle: strips of the lens, whose lengths are
//            elementary, summed by Gauss-Legendre between the heights where the rectangle's image
//            meets the rim (1e-12 of the largest I); its flux over the lens's points, and the
//            slopes that each takes from the rectangle, to 1e-9
//   window   Snell and Fresnel at both faces
//
// Limiting case: one cone of 90 degrees, of exponent 1 and weight 1, is 1 / pi on the axis.
#pragma once

#include "rig/beam/beam.h"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

namespace aphotic {

// Across and along an emitter or a pattern, unit vectors: forward projected on the plane across the
// axis, or down within a millionth of a radian of fore and aft, and the direction to its right
// (docs/reference/rig.md).
struct StrobeSides {
    Eigen::Vector3d across;
    Eigen::Vector3d along;
};
[[nodiscard]] StrobeSides sides_about(const Eigen::Vector3d& axis);

class TracedBeam {
  public:
    // axis: the strobe's, a unit vector.
    TracedBeam(const Beam& beam, const Eigen::Vector3d& axis);

    // The direction has any length but 0.
    [[nodiscard]] double intensity(const Eigen::Vector3d& towards) const;

    // Adds the angles x, from -pi to pi, at which cos(x) e + sin(x) u crosses a circle about the
    // axis or an edge where I is not smooth; those of a pattern behind a window are omitted. e and
    // u: unit vectors, one across the other.
    void add_crossings(const Eigen::Vector3d& e,
                       const Eigen::Vector3d& u,
                       std::vector<double>& x_rad) const;

    // Whether there may be light behind the plane across the axis: only for a table.
    [[nodiscard]] bool shines_backwards() const { return shines_backwards_; }

    // Whether either direction is within an angle of an edge, where I has a step or falls as
    // steeply, or the two are on different sides of one. Smooth beams have none.
    [[nodiscard]] bool is_on_edge(const std::array<Eigen::Vector3d, 2>& towards,
                                  double within_rad) const;

    // The n of the cos^n with I's largest slope and curvature between its edges, seen from a lamp
    // that moves across the axis. The largest exponent of sharp cones; for all others an estimate,
    // by differences over a degree, with I limited to at least kDimmest of the largest.
    static constexpr double kDimmest = 0.1;
    [[nodiscard]] double steepness() const;

  private:
    struct TracedCone {
        double on_axis;
        double exponent;
        double cos_edge;
        // 1 - cos at the start and end of a soft edge.
        bool is_soft;
        double versine_full;
        double versine_none;
    };
    // The directions within an angle of one.
    struct Cap {
        Eigen::Vector3d centre;
        double radius_rad;
    };
    // The part of a cap's rim that is within the other caps.
    struct Edge {
        Cap cap;
        std::vector<Cap> within;
    };

    void place_cones();
    void place_edges();
    void place_rectangle(const std::array<Cap, 4>& sides, const std::array<bool, 4>& has_step);
    [[nodiscard]] bool reaches_the_plane() const;
    [[nodiscard]] double intensity_in_air(const Eigen::Vector3d& towards) const;
    [[nodiscard]] double intensity_of_cones(const Eigen::Vector3d& towards) const;
    [[nodiscard]] Eigen::Vector3d in_lamp(const Eigen::Vector3d& towards) const;
    [[nodiscard]] double steepness_at(const Eigen::Vector3d& towards, double most) const;

    // A direction, and the window's effect on an angle about it.
    struct Aim {
        Eigen::Vector3d towards;
        double within_rad;
    };
    [[nodiscard]] Aim in_air(const Aim& in_water) const;
    [[nodiscard]] static bool is_on(const Edge& edge, const std::array<Aim, 2>& aims);

    Beam beam_;
    Eigen::Vector3d axis_;
    Eigen::Vector3d along_;  // of the pattern, rotated
    Eigen::Vector3d across_;
    double scale_ = 1.0;  // of the pattern: 1 / its flux
    std::vector<TracedCone> cones_;
    std::vector<Edge> edges_;           // in air, if there is a window
    std::optional<Cap> end_of_window_;  // in water, if light reaches it
    bool shines_backwards_ = false;
};

}  // namespace aphotic
