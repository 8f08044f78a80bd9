// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's mesh (relief_mesh.h) as its cameras see it: the depth map of each, from one ray in
// water per pixel. The world here is x north, y east, z down [m], and a camera is placed in it by
// its pupil and the rotation of its frame (rig/geometry.h), so that a point P of that frame is at
//
//   pupil + turn P
//
// Vertices are floats relative to the middle of the mesh's box, 0.06 mm at 1 km, and all else is
// double.
#pragma once

#include "light/triangle_mesh.h"
#include "rig/geometry.h"
#include "survey/relief/depth_map.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <functional>
#include <optional>
#include <string_view>

namespace aphotic {

// The axes of a mesh: those of grids of heights and of projected meshes; of grids of depths; or of
// meshes in the vehicle's world.
enum class ReliefAxes { EastNorthUp, EastNorthDown, NorthEastDown };
inline constexpr std::array<std::string_view, 3> kReliefAxesWords{
    "east-north-up", "east-north-down", "north-east-down"};

struct CameraStation {
    Eigen::Vector3d pupil_m;
    Eigen::Matrix3d turn;
};

// For a place of the image, as in lightmap/relief_map.h.
using PixelRay = std::function<WaterRay(double column, double row)>;

class ReliefScene {
  public:
    ReliefScene(const Mesh& mesh, ReliefAxes axes);

    [[nodiscard]] const Eigen::AlignedBox3d& box_m() const { return box_m_; }

    // z of the highest triangle at this place.
    [[nodiscard]] std::optional<double> floor_at(double north_m, double east_m) const;

    // Along the axis; a hole where a ray meets nothing.
    [[nodiscard]] DepthMap depth_map(const CameraStation& camera,
                                     const PixelRay& ray,
                                     int width_px,
                                     int height_px) const;

    // Whether any of a few rays over the image meets it.
    [[nodiscard]] bool is_seen(const CameraStation& camera,
                               const PixelRay& ray,
                               int width_px,
                               int height_px) const;

  private:
    // Along the axis.
    [[nodiscard]] std::optional<double> depth_m(const CameraStation& camera,
                                                const WaterRay& ray) const;

    Eigen::AlignedBox3d box_m_;
    TriangleMesh mesh_;
};

}  // namespace aphotic
