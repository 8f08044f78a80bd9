// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the relief hides a lamp from one of its places. Its mesh has a vertex at every n-th
// pixel, with n such that the mesh is at most kShadowMesh_px wide. Anything narrower casts no
// shadow, and where the range jumps, the mesh is a wall down to the surface behind.
//
// A ray starts kShadowBias of the point's distance off the floor, along its normal and towards the
// lamp, since measured ranges are rougher than the floor.
#pragma once

#include "light/relief.h"
#include "light/triangle_mesh.h"

#include <Eigen/Core>

namespace aphotic {

inline constexpr int kShadowMesh_px = 256;
inline constexpr double kShadowBias = 0.005;

class ReliefShadow {
  public:
    // The relief must outlive it.
    explicit ReliefShadow(const Relief& relief);

    // Between neighbouring vertices of the mesh.
    [[nodiscard]] int step_px() const { return step_px_; }

    [[nodiscard]] bool hides(std::size_t pixel, const Eigen::Vector3d& lamp_m) const;

  private:
    const Relief& relief_;
    int step_px_;
    TriangleMesh mesh_;
};

}  // namespace aphotic
