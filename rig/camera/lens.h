// SPDX-License-Identifier: BSD-3-Clause
//
// Which way a pixel looks, in the air behind the port: a pinhole with square pixels,
//
//   (x, y, z) ~ (height/2 - row, column - width/2, focal length/pixel pitch)
//
// or what its calibration tells (lens_model.h). In the sled's frame: the top row forward, the right
// column starboard. Pixel (0, 0)'s centre is (0.5, 0.5).
//
// Who needs a lens's rays asks here. Pinholes are known besides to scene_gen/rig_sdl.h, which says
// them to POV-Ray. The reference has lenses of its own (validation/).
#pragma once

#include "rig/camera/camera.h"

#include <array>
#include <map>
#include <string>

namespace aphotic {

// Unit vector of the point (column, row) of the image. Beyond the image it may be none, which is an
// InputError.
[[nodiscard]] Eigen::Vector3d direction_in_air(const Camera& camera, double column, double row);

// Of a camera without a lens, of any length; T may be several numbers at a time.
template <typename T>
[[nodiscard]] std::array<T, 3> pinhole_way(const Camera& camera, const T& column, const T& row) {
    return {(0.5 * camera.height_px - row) * camera.pixel_pitch_m,
            (column - 0.5 * camera.width_px) * camera.pixel_pitch_m,
            T(camera.focal_length_m)};
}

// The largest angle of any pixel off the camera's axis [rad]: in water it is no larger.
[[nodiscard]] double half_view_rad(const Camera& camera);

// An image of other pixels, so many times as large, about the same middle: the same view where as
// many times fewer are asked for.
void enlarge_pixels(Camera& camera, double factor, int width_px, int height_px);

// The pinhole with square pixels whose image of as many columns and rows, about the same axis,
// shows all that the camera's does.
struct Pinhole {
    double focal_length_m = 0.0;
    double sensor_width_m = 0.0;
};
[[nodiscard]] Pinhole pinhole_about(const Camera& camera);

// Whether the image, made larger about its middle by a factor, shows a point in the water without a
// port.
[[nodiscard]] bool is_in_view(const Camera& camera, const Eigen::Vector3d& point_m, double factor);

// Lenses of the same signature see alike; by key, as words and numbers.
[[nodiscard]] std::map<std::string, std::string> lens_signature(const Camera& camera);

}  // namespace aphotic
