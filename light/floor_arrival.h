// SPDX-License-Identifier: BSD-3-Clause
//
// A lamp's effect on the floor point that a ray shows, without wavelength: the only implementation,
// apart from the reference's.
//
//   S = Phi (rho diffuse + highlight) exp(-K path)
//
//   diffuse   = share I cos(i) / d^2                     share   power over pi and number of lamps
//   highlight = share I phong max(0, m.l)^size / d^2     I       the beam's intensity
//   path      = d + r
//
// With V, D, w and H of the ray (floor_ray.h), h the lamp's height above the floor, m the ray
// mirrored at the floor and l the direction to the lamp,
//
//   d = |V|/w     r = H/w     cos(i) / d^2 = h w^3 / |V|^3     m.l = (2 w^2 h - D.V) / |V|
//
// Straight above the floor at a metre, a lamp of share 1 and I = 1 gives diffuse = 1.
#pragma once

#include "light/floor_ray.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cmath>
#include <optional>

namespace aphotic {

// For uniform light, from a lamp at height h, at the length |V|.
template <typename T>
struct Arriving {
    T per_area;  // cos(i) / d^2  [1/m^2]
    T path_m;    // d + r
};
template <typename T, typename Height>
[[nodiscard]] Arriving<T> arriving(const Height& lamp_height_m,
                                   const Height& height_m,
                                   const T& down,
                                   const T& length) {
    const T share = down / length;
    return {.per_area = lamp_height_m * share * share * share,
            .path_m = (height_m + length) / down};
}

// The highlight's counterpart of cos(i). along: D.V
[[nodiscard]] inline double highlight_per_area(
    const Seafloor& floor, double lamp_height_m, double down, double along, double length) {
    const double aligned = (2.0 * down * down * lamp_height_m - along) / length;
    if (!(aligned > 0.0)) return 0.0;  // where phong_size is 0 too
    return down * down / (length * length) * floor.phong * std::pow(aligned, floor.phong_size);
}

struct FloorArrival {
    Eigen::Vector3d towards = Eigen::Vector3d::Zero();  // V
    double diffuse = 0.0;
    double highlight = 0.0;
    double path_m = 0.0;
};

// For a strobe as a point, with no edge of its beam between this ray and lit_m, a place that it
// certainly lights. Empty if the ray sees no floor; no light if the lamp is not above it.
[[nodiscard]] std::optional<FloorArrival> arrival_of(const Rig& rig,
                                                     const Strobe& strobe,
                                                     const WaterRay& ray,
                                                     const Eigen::Vector3d& lit_m);

}  // namespace aphotic
