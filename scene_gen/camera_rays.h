// SPDX-License-Identifier: BSD-3-Clause
//
// The rays of a calibrated lens for POV-Ray's mesh_camera: a mesh of one triangle a pixel, whose
// centroid is the pupil and whose normal is the ray. For a ray along (x, y, 1) in POV-Ray's frame,
//
//   (-1, -1, x + y)   (-1, 2, x - 2y)   (2, -1, y - 2x)
//
// POV-Ray 3.7 keeps them as floats, so that directions are right to 1e-7, and takes for each row of
// the image the faces of the row above: frames have kRowsAbove rows more, and the first ones are
// not rendered.
#pragma once

#include "rig/rig.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace aphotic {

inline constexpr std::string_view kCameraRaysFile = "aphotic_rays.inc";
inline constexpr int kRowsAbove = 1;

// Of a frame; 0 for a pinhole.
[[nodiscard]] int rows_above(const Camera& camera);

// Of the file, at most.
[[nodiscard]] std::uint64_t bytes_of_rays(const Camera& camera);

// #declare Aphotic_Camera_Rays = mesh2 { ... }. The camera has a lens.
[[nodiscard]] std::string camera_rays_sdl(const Camera& camera);

}  // namespace aphotic
