// SPDX-License-Identifier: BSD-3-Clause
//
// Dispersion: behind a port every wavelength has its own ray. Everything that depends on it asks
// here: whether rays part, how far, and how light at all wavelengths follows from the rays of a
// few:
//
//   L(n) = sum_j L(n_j) l_j(n),      l_j(n) = prod_{m != j} (n - n_m) / (n_j - n_m)
//
// n    the water's refractive index      n_j  both ends of its range, and its middle
// l_j  Lagrange polynomials: the weight of node j's ray at another wavelength
//
// Accurate to third order in n where L is smooth. A kink of L lies somewhere between two nodes; a
// caller that cannot rule one out checks halfway between nodes (light/floor_light.h).
//
// Rendered with another wavelength's indices, an image is shifted at its corners by
//
//   shift = |P(lambda_a) - P(lambda_b)| / |P(lambda_b) - P'(lambda_b)|     [pixel]
//
// P   intersection of the corner's ray with the plane at the sled's altitude across the
//     camera's axis            P'  the same, one pixel nearer to the image's middle
//
// Without a port one node suffices, with weight 1, and nothing is shifted.
#pragma once

#include "rig/rig.h"

#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kIndexNodes = 3;

[[nodiscard]] inline bool disperses(const Rig& rig) {
    return rig.camera.port.has_value();
}

// The wavelengths of this many nodes, from the range's first to its last.
[[nodiscard]] std::vector<double> index_nodes_nm(const Rig& rig, std::size_t nodes = kIndexNodes);

// l_j at the water's index there.
[[nodiscard]] double index_share(const Rig& rig,
                                 const std::vector<double>& nodes_nm,
                                 std::size_t node,
                                 double lambda_nm);

// The shift of lambda_a_nm's image against lambda_b_nm's.
[[nodiscard]] double corner_shift_px(const Rig& rig, double lambda_a_nm, double lambda_b_nm);

}  // namespace aphotic
