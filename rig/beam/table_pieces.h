// SPDX-License-Identifier: BSD-3-Clause
//
// A round table's intensity as cubics over the angle V off the axis, for integration: a table in
// half degrees has a kink each half degree, and a quadrature rule must stop at each.
//
//   I(V) = c0 + c1 x + c2 x^2 + c3 x^3      x = (V - first) / (last - first)
//
// Each piece extends as far as a least-squares fit stays within `off` of the largest intensity, at
// the table's nodes and midway between them, where a straight line between nodes is farthest from a
// smooth curve; at least from a node to the next, as the straight line. off = 0 thus reproduces the
// table.
#pragma once

#include "rig/beam/beam_table.h"

#include <array>
#include <vector>

namespace aphotic {

struct TablePiece {
    double first_rad = 0.0;
    double last_rad = 0.0;
    std::array<double, 4> c{};

    // Extrapolated past its ends.
    [[nodiscard]] double at(double vertical_rad) const {
        const double x = (vertical_rad - first_rad) / (last_rad - first_rad);
        return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
    }
};

// For type C with one H. The pieces increase, without gaps, from the first V to the last.
[[nodiscard]] std::vector<TablePiece> pieces_of(const BeamTable& table, double off);

}  // namespace aphotic
