// SPDX-License-Identifier: BSD-3-Clause
//
// The true poses of a simulated survey, in COLMAP's text format: cameras.txt, images.txt, and
// points3D.txt without points.
//
//   x_camera = R(q) X + t,     t = (0, 0, altitude)
//
// x_camera: X right, Y down, Z along the axis. X: the world of an image, x to starboard and y
// forward along the level floor, z up, the origin where the camera's axis meets the floor [m]. A
// scene that places its floor there, and is the same in all images, is thus one world for all of
// them; anything drawn anew for each image is a world of its own. Straight down q = (0, 1, 0, 0), a
// half turn about x.
//
// The lens is COLMAP's with the same formula (rig/camera/lens_model.h). COLMAP has no port: behind
// one the camera is the lens in air, as a comment in the file states.
#pragma once

#include "survey/simulate/flight.h"

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

// An InputError for a lens without a COLMAP model, or for a name with a blank, which its text
// format cannot hold.
void require_colmap(const Camera& camera, const std::vector<Leg>& legs);

[[nodiscard]] std::string colmap_cameras(const Camera& camera);
[[nodiscard]] std::string colmap_images(const std::vector<Leg>& legs, const std::string& suffix);

// All three files.
void write_colmap(const std::filesystem::path& folder,
                  const Camera& camera,
                  const std::vector<Leg>& legs,
                  const std::string& suffix);

}  // namespace aphotic
