// SPDX-License-Identifier: BSD-3-Clause
//
// Light through a port, which every wavelength takes by a ray of its own, from the rays of a few:
//
//   L(n) = sum_j L(n_j) l_j(n),      l_j(n) = prod_{m != j} (n - n_m) / (n_j - n_m)
//
// n    the water's refractive index      n_j  both ends of its range, and its middle
// l_j  Lagrange's polynomials: what light of node j's ray counts at another wavelength
//
// Right to the third order of n where L is smooth. A kink of L lies between two nodes, wherever it
// is; who cannot rule one out looks half way between nodes (lightmap/dispersed_light.h).
//
// Without a port one node serves, and counts 1.
#pragma once

#include "rig/rig.h"

#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kIndexNodes = 3;

// The wavelengths of so many nodes, from the range's first to its last.
[[nodiscard]] std::vector<double> index_nodes_nm(const Rig& rig, std::size_t nodes = kIndexNodes);

// l_j at the water's index there.
[[nodiscard]] double index_share(const Rig& rig,
                                 const std::vector<double>& nodes_nm,
                                 std::size_t node,
                                 double lambda_nm);

}  // namespace aphotic
