// SPDX-License-Identifier: BSD-3-Clause
//
// The directions from a lamp to the floor that a tile of pixels sees: those within a cone about one
// of them that contains the directions to the tile's corners and to the middles of its sides,
// kTileRoom times as wide to allow for the lens's bending. On a plane, seen through a pinhole, the
// corners are the farthest off.
#pragma once

#include "light/floor_ray.h"
#include "rig/beam/beam_crease.h"

#include <Eigen/Core>

#include <array>
#include <span>

namespace aphotic {

inline constexpr double kTileRoom = 1.1;

// Places of a tile in pixels from its first one's centre, as (column, row); its middle first.
inline constexpr std::size_t kTilePlaces = 9;
[[nodiscard]] std::array<std::array<double, 2>, kTilePlaces> tile_places(int width, int height);

struct TileCone {
    Eigen::Vector3d middle = Eigen::Vector3d::UnitZ();
    double radius_rad = 0.0;
    bool sees_all = true;  // all of these rays see the floor
    bool sees_any = false;
};

// For a lamp and the rays of a tile's places, the middle one's first.
[[nodiscard]] TileCone tile_cone(const Eigen::Vector3d& lamp_m, std::span<const FloorRay> rays);

// Whether a crease may enter the cone; false is certain.
[[nodiscard]] bool comes_into(const TileCone& cone, const Crease& crease);

// A cone about the normals of the planes through the lamp and each ray.
[[nodiscard]] TileCone plane_cone(const Eigen::Vector3d& lamp_m, std::span<const FloorRay> rays);

}  // namespace aphotic
