// SPDX-License-Identifier: BSD-3-Clause
//
// A strobe's beam, prepared for many directions: a round one as its profile
// (rig/beam/round_profile.h), a table over two angles as its cells (rig/beam/table_cells.h), others
// by rig/beam/beam.h's formulas, with the window's effect as a profile too.
//
//   I(w)   intensity in the direction w, per unit of the lamp's power   [1/sr]
//
// Directions are in the sled's frame, of any length but 0.
#pragma once

#include "base/lanes.h"
#include "rig/beam/beam.h"
#include "rig/beam/beam_crease.h"
#include "rig/beam/round_profile.h"
#include "rig/beam/table_cells.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace aphotic {

class BeamLight {
  public:
    BeamLight(const Beam& beam, const Eigen::Vector3d& axis);

    // For directions of these lengths.
    [[nodiscard]] Lanes at(const LaneVector& towards, const Lanes& length) const;
    // As if the edges that light the directions `from` were absent (continued_intensity()).
    [[nodiscard]] Lanes continued(const LaneVector& towards,
                                  const Lanes& length,
                                  const LaneVector& from,
                                  const Lanes& from_length) const;

  private:
    // Without the window's transmission.
    [[nodiscard]] Lanes of_pattern(const LaneVector& towards, const Lanes& length) const;

    [[nodiscard]] Lanes cosine(const LaneVector& towards, const Lanes& length) const;

    Beam beam_;
    BeamFrame frame_;
    bool has_edge_;
    std::optional<RoundProfile> profile_;  // of a round beam
    // For others, whose frame is rotated like the pattern.
    BeamFrame pattern_frame_;
    Beam in_air_;
    std::optional<RoundProfile> window_factor_;
    std::optional<TableCells> cells_;
};

// Where a strobe's beam ends sharply: circles about its axis, and a rim that is not a circle
// (rig/beam/beam.h). A strobe without power has no edge.
class BeamEdges {
  public:
    explicit BeamEdges(const Strobe& strobe);

    [[nodiscard]] std::size_t count() const { return cosines_.size() + (has_rim_ ? 1 : 0); }
    [[nodiscard]] bool is_within(std::size_t edge, const Eigen::Vector3d& towards) const;
    // The creases that it may follow.
    [[nodiscard]] std::vector<Crease> creases(std::size_t edge) const;

  private:
    std::vector<double> cosines_;
    bool has_rim_ = false;
    Beam beam_;
    BeamFrame frame_;
};

}  // namespace aphotic
