// SPDX-License-Identifier: BSD-3-Clause
//
// A strobe's beam, made ready to be asked for many directions: a round one by its profile
// (rig/beam/round_profile.h), others by rig/beam/beam.h's formulas.
//
//   I(w)   intensity in the direction w, per unit of the lamp's power   [1/sr]
//
// Directions are in the sled's frame, of any length but 0.
#pragma once

#include "rig/beam/beam.h"
#include "rig/beam/beam_crease.h"
#include "rig/beam/round_profile.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace aphotic {

class BeamLight {
  public:
    BeamLight(const Beam& beam, const Eigen::Vector3d& axis);

    [[nodiscard]] double at(const Eigen::Vector3d& towards) const;
    // As though what lights the direction `from` had no edge (continued_intensity()).
    [[nodiscard]] double continued(const Eigen::Vector3d& towards,
                                   const Eigen::Vector3d& from) const;

  private:
    Beam beam_;
    BeamFrame frame_;
    std::optional<RoundProfile> profile_;  // of a beam that is round
};

// Where a strobe's beam ends sharply: circles about its axis, and a rim that is none
// (rig/beam/beam.h). A strobe without power has no edge.
class BeamEdges {
  public:
    explicit BeamEdges(const Strobe& strobe);

    [[nodiscard]] std::size_t count() const { return cosines_.size() + (has_rim_ ? 1 : 0); }
    [[nodiscard]] bool is_within(std::size_t edge, const Eigen::Vector3d& towards) const;
    // What it may pass along.
    [[nodiscard]] std::vector<Crease> creases(std::size_t edge) const;

  private:
    std::vector<double> cosines_;
    bool has_rim_ = false;
    Beam beam_;
    BeamFrame frame_;
};

}  // namespace aphotic
