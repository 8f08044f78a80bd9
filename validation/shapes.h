// SPDX-License-Identifier: BSD-3-Clause
//
// The intersections of a ray with the shapes of a rig, in double precision, for the reference
// tracer: sphere, box and mesh.
//
//   sphere  t^2 + 2 b t + c = 0, with the root that does not cancel taken first and the other from
//           their product c
//   box     the slabs between its pairs of faces
//   mesh    Moeller and Trumbore for a triangle ("Fast, minimum storage ray-triangle
//           intersection", Journal of Graphics Tools 2(1), 21-28, 1997), found through Eigen's
//           hierarchy of boxes
//
// A sphere of radius R, seen from distance d along the line through its centre, is entered at d - R
// and left at d + R.
#pragma once

#include "rig/rig.h"

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

#include <optional>
#include <variant>
#include <vector>

namespace aphotic {

struct SightLine {
    Eigen::Vector3d origin_m;
    Eigen::Vector3d direction;  // unit
};

// A part of a ray, without its ends.
struct Stretch {
    double from_m;
    double to_m;
};

struct Hit {
    double distance_m = 0.0;
    Eigen::Vector3d normal;  // unit; either sign
    int face = 0;            // of a box 0 to 5, of a mesh the triangle, of a sphere 0
};

class TracedShape {
  public:
    explicit TracedShape(const Shape& shape);

    // The nearest point where the line meets the surface within the stretch. skip: a face to
    // ignore, because the line starts on it; on a sphere or a box, which are convex, all faces are
    // then ignored. -1 for none.
    [[nodiscard]] std::optional<Hit> first_hit(const SightLine& line,
                                               Stretch stretch,
                                               int skip = -1) const;

    // The distance from a point to the box around the shape's nearest part, 0 within it: a lower
    // bound of the distance to the shape itself.
    [[nodiscard]] double least_distance_m(const Eigen::Vector3d& point_m) const;

    [[nodiscard]] const Eigen::AlignedBox3d& bounds_m() const { return bounds_m_; }

    [[nodiscard]] bool is_mesh() const { return std::holds_alternative<Triangles>(shape_); }

  private:
    struct Triangle {
        Eigen::Vector3d a_m, ab_m, ac_m;
        int face;
    };
    using Triangles = Eigen::KdBVH<double, 3, Triangle>;
    struct Nearest;

    static Triangles triangles_of(const Mesh& mesh);

    std::variant<Sphere, Box, Triangles> shape_;
    std::vector<Eigen::AlignedBox3d> parts_m_;
    Eigen::AlignedBox3d bounds_m_;
};

}  // namespace aphotic
