// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles intersected by rays, with Embree (I. Wald et al., ACM Transactions on Graphics 33(4),
// 2014). No ray slips between two that share an edge. Vertices are floats; the intersection of a
// ray with the plane of the triangle that it hits is computed in double.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace aphotic {

class TriangleMesh {
  public:
    // Triangles by their vertices' indices; vertices in use must be finite.
    TriangleMesh(std::span<const Eigen::Vector3f> vertices_m,
                 std::span<const std::array<int, 3>> triangles);

    // Whether a triangle lies between from + least way and from + way.
    [[nodiscard]] bool blocks(const Eigen::Vector3f& from_m,
                              const Eigen::Vector3f& way,
                              float least) const;

    // The distance to the first triangle, in units of `way`.
    [[nodiscard]] std::optional<double> first_hit(const Eigen::Vector3d& from_m,
                                                  const Eigen::Vector3d& way) const;

  private:
    struct Scene;
    std::shared_ptr<const Scene> scene_;
};

// Two triangles for each four neighbouring places of a grid, given the vertex of each place, row by
// row; -1: a place without one.
[[nodiscard]] std::vector<std::array<int, 3>> grid_triangles(const std::vector<int>& vertices,
                                                             std::size_t width);

}  // namespace aphotic
