// SPDX-License-Identifier: BSD-3-Clause
//
// The rays of a calibrated lens for POV-Ray's mesh_camera: a grid of points (column, row) of the
// image, each with its ray d as the mesh's normal and its place in the image as uv,
//
//   u = (column - 1/2) / width,  v = 1 - (row - 1/2) / height
//
// for POV-Ray looks a pixel up without the half (distribution 3), and interpolates the normals of
// the face that it finds. In the middle of an edge of the grid that is off by
//
//   | (a + b) / |a + b| - d |,
//
// which kRayErrorRad bounds: the grid is as fine as the lens demands, and no finer than the pixels,
// where it is exact. POV-Ray keeps floats, 6e-8 of a slope. The mesh itself is a billionth of a
// POV-Ray unit to a pixel, since rays begin on it.
#pragma once

#include "rig/rig.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace aphotic {

inline constexpr std::string_view kCameraRaysFile = "aphotic_rays.inc";
inline constexpr double kRayErrorRad = 2e-6;

// Of the file, at most.
[[nodiscard]] std::uint64_t bytes_of_rays(const Camera& camera);

// #declare Aphotic_Camera_Rays = mesh2 { ... }. The camera has a lens.
[[nodiscard]] std::string camera_rays_sdl(const Camera& camera);

}  // namespace aphotic
