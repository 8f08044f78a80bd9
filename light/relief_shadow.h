// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the relief blocks the way from one of its places to a lamp. The relief is a mesh through
// every nth of its pixels, with n such that it is at most kShadowMesh_px wide; narrower features
// cast no shadow, and where the range jumps, the mesh is a wall down to the background. Rays are
// traced by Embree (I. Wald et al., ACM Transactions on Graphics 33(4), 2014).
//
// A ray starts kShadowBias of the point's distance off the floor, along its normal and towards the
// lamp, since measured ranges are rougher than the floor.
#pragma once

#include "light/relief.h"

#include <Eigen/Core>

#include <memory>

namespace aphotic {

inline constexpr int kShadowMesh_px = 256;
inline constexpr double kShadowBias = 0.005;

class ReliefShadow {
  public:
    // The relief must outlive it.
    explicit ReliefShadow(const Relief& relief);

    // Between two vertices of the mesh.
    [[nodiscard]] int step_px() const { return step_px_; }

    [[nodiscard]] bool hides(std::size_t pixel, const Eigen::Vector3d& lamp_m) const;

  private:
    struct Mesh;
    const Relief& relief_;
    int step_px_;
    std::shared_ptr<const Mesh> mesh_;
};

}  // namespace aphotic
