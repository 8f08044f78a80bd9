// SPDX-License-Identifier: BSD-3-Clause
//
// What the scene generator derives from an object's shape: how far it reaches, how close it comes,
// and whether it can affect the image. It traces no light: each answer is a conservative bound from
// the object's ball and bounds.
//
// bounds          the smallest box along the sled's axes that holds the object
// ball            the sphere about that box; a lamp at d sees it within asin(R/d) of its middle
// distance        from a point to the nearest of the object, 0 inside of a sphere or a box; of a
//                 mesh, to its nearest triangle
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"

#include <Eigen/Geometry>

namespace aphotic {

[[nodiscard]] Eigen::AlignedBox3d bounds_m(const Shape& shape);

[[nodiscard]] double distance_m(const Shape& shape, const Eigen::Vector3d& point_m);

// Whether the point is inside. A mesh contains what it encloses, whatever its triangles'
// orientation: a half line from inside leaves it one time more often than it enters. An open mesh
// does so from some places.
[[nodiscard]] bool holds(const Shape& shape, const Eigen::Vector3d& point_m);

// False is certain, true may be wrong.
[[nodiscard]] bool may_be_in_view(const Rig& rig, const Object& object);
// By the strobe's own beam, or by a part of it.
[[nodiscard]] bool may_light(const Strobe& strobe, const Beam& beam, const Object& object);

// From a point of the strobe to the nearest thing in view that it may light, including the floor
// below it [m].
[[nodiscard]] double least_throw_m(const Rig& rig,
                                   const Strobe& strobe,
                                   const Eigen::Vector3d& lamp_m);

[[nodiscard]] bool has_highlight(const Rig& rig);

}  // namespace aphotic
