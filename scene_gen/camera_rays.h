// SPDX-License-Identifier: BSD-3-Clause
//
// The rays of a calibrated lens for POV-Ray's mesh_camera, which looks a pixel up in the mesh by uv
// (distribution 3) and uses the face's interpolated normal as the ray. The mesh is a grid over the
// image: each point (column, row) has its ray as normal, and as uv
//
//   u = (column - 1/2) / width,  v = 1 - (row - 1/2) / height
//
// since POV-Ray omits the half pixel. It never looks beyond column width - 1 or above row 1, so all
// rays of the last column and of the first row are looked up there.
//
// The error of POV-Ray's ray between two points, with a and b the rays there and d the lens's own
// halfway,
//
//   | (a + b) / |a + b| - d |
//
// is bounded by kRayErrorRad: the grid is as fine as the lens requires, up to a point per pixel,
// where rays are exact. POV-Ray interpolates not the rays (x, y, z) but (x, y, m z), which it
// converts to rays afterwards: m = 8 needs a fifth of the faces for a lens that is nearly a
// pinhole, whose rays a large m leaves exact, and m = 1 is best for a fisheye.
#pragma once

#include "rig/rig.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace aphotic {

inline constexpr std::string_view kCameraRaysFile = "aphotic_rays.inc";

// A ray off by this much changes light by 5e-5, a tenth of a half float's step, where light changes
// e-fold in 2.3 degrees of view; anything steeper counts as an edge (validation/tracer.h). It is
// 0.01 pixels of a camera of 24 megapixels. A finer grid costs time, since POV-Ray searches the
// faces one after another: twice the time for half the error.
inline constexpr double kRayErrorRad = 2e-6;

// POV-Ray has no rays for narrower images: it does not look at u <= -0.1.
[[nodiscard]] constexpr int least_width_px(bool is_antialiased) {
    return is_antialiased ? 5 : 2;
}

// The file's largest size.
[[nodiscard]] std::uint64_t bytes_of_rays(const Camera& camera);

// #declare Aphotic_Camera_Rays = mesh2 { ... }. The camera has a lens.
[[nodiscard]] std::string camera_rays_sdl(const Camera& camera);

}  // namespace aphotic
