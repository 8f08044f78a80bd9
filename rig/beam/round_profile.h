// SPDX-License-Identifier: BSD-3-Clause
//
// A beam that is round about its axis, as polynomials in one variable: cones with their exponents
// and soft edges, round tables, and either behind a window, whose factor is included.
//
//   I(theta) = p_k(q),      q = 2 sin(theta / 2) = sqrt(2 - 2 cos(theta))
//
// theta  off the axis; behind a window in air, where the beam ends smoothly at 90 degrees
// k      the piece with q in it: pieces end at each edge and kink, and where a polynomial of degree
//        kProfileOrder - 1 would be off by more than kProfileError of the largest I in the piece
//
// q is as smooth as theta and costs one root. Pieces between two edges form a region: a direction
// evaluated as if an edge were not there uses its own region's last polynomial.
#pragma once

#include "base/lanes.h"
#include "rig/beam/beam.h"
#include "rig/beam/cell_search.h"

#include <array>
#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kProfileOrder = 6;
inline constexpr double kProfileError = 1e-9;

class RoundProfile {
  public:
    // The beam must be round: is_round().
    explicit RoundProfile(const Beam& beam);

    // By the cosine off the axis in water.
    [[nodiscard]] Lanes at(const Lanes& cosine) const;
    // Without any edge between these directions and those of the other cosines.
    [[nodiscard]] Lanes continued(const Lanes& cosine, const Lanes& cosine_from) const;

  private:
    struct Piece {
        double first = 0.0;
        double per_width = 0.0;
        std::array<double, kProfileOrder> c{};  // in 0 to 1 over the piece
        std::size_t region = 0;
    };
    // q; 2, beyond the last piece, where a window transmits no light.
    [[nodiscard]] Lanes chord(const Lanes& cosine) const;
    [[nodiscard]] static double value(const Piece& piece, double q);

    double window_index_ = 1.0;  // of the water, behind a window
    bool has_window_ = false;
    std::vector<Piece> pieces_;
    CellSearch piece_at_;  // by q
};

[[nodiscard]] bool is_round(const Beam& beam);

}  // namespace aphotic
