// SPDX-License-Identifier: BSD-3-Clause
//
// The scene generator's use of an object's shape: its extent, its distance, and whether it can
// affect the image. No light is traced: each result is a conservative bound from the object's ball
// and bounds.
//
// bounds          the smallest box along the sled's axes that contains the object
// ball            the sphere about that box; a lamp at d sees it within asin(R/d) of its middle
// distance        from a point to the object's nearest point, 0 inside a sphere or a box; of a
//                 mesh, to its nearest triangle
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"

#include <Eigen/Geometry>

namespace aphotic {

[[nodiscard]] Eigen::AlignedBox3d bounds_m(const Shape& shape);

[[nodiscard]] double distance_m(const Shape& shape, const Eigen::Vector3d& point_m);

// Whether the point is inside. A mesh contains the points that it encloses, whatever its triangles'
// orientation: a half line from inside leaves it once more than it enters. For an open mesh that
// holds for some points only.
[[nodiscard]] bool holds(const Shape& shape, const Eigen::Vector3d& point_m);

// False is certain, true may be wrong.
[[nodiscard]] bool may_be_in_view(const Rig& rig, const Object& object);
// By the strobe's own beam, or by a part of it.
[[nodiscard]] bool may_light(const Strobe& strobe, const Beam& beam, const Object& object);

// The distance from a point of the strobe to the nearest surface in view that it may light,
// including the floor below it [m].
[[nodiscard]] double least_throw_m(const Rig& rig,
                                   const Strobe& strobe,
                                   const Eigen::Vector3d& lamp_m);

[[nodiscard]] bool has_highlight(const Rig& rig);

}  // namespace aphotic
