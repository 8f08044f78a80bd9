// SPDX-License-Identifier: BSD-3-Clause
//
// The direction in which a pixel looks, in the air behind the port: a pinhole with square pixels,
//
//   (x, y, z) ~ (height/2 - row, column - width/2, focal length/pixel pitch)
//
// or the calibration's lens (lens_model.h). In the sled's frame: the top row forward, the right
// column starboard. Pixel (0, 0)'s centre is (0.5, 0.5).
//
// Callers use these rays and do not know the lens. The exception is scene_gen/rig_sdl.h, which
// describes pinholes to POV-Ray. The reference has its own lenses (validation/).
#pragma once

#include "rig/camera/camera.h"

#include <array>
#include <map>
#include <string>

namespace aphotic {

// Unit vector for the point (column, row) of the image. An InputError if the model has none, which
// is possible only outside the image.
[[nodiscard]] Eigen::Vector3d direction_in_air(const Camera& camera, double column, double row);

// For a camera without a lens model, of any length; T may be a pack of numbers.
template <typename T>
[[nodiscard]] std::array<T, 3> pinhole_way(const Camera& camera, const T& column, const T& row) {
    return {(0.5 * camera.height_px - row) * camera.pixel_pitch_m,
            (column - 0.5 * camera.width_px) * camera.pixel_pitch_m,
            T(camera.focal_length_m)};
}

// The largest angle of any pixel off the camera's axis [rad], in air; in water it is no larger.
[[nodiscard]] double half_view_rad(const Camera& camera);

// An image with different pixels, larger by this factor, about the same middle: the same view if it
// has fewer pixels by the same factor.
void enlarge_pixels(Camera& camera, double factor, int width_px, int height_px);

// The same view in this many columns, and in the nearest number of rows: up to half a row is lost
// or gained.
void scale_to_width(Camera& camera, int width_px);

// The pinhole with square pixels whose image, with as many columns and rows and the same axis,
// contains the camera's whole view.
struct Pinhole {
    double focal_length_m = 0.0;
    double sensor_width_m = 0.0;
};
[[nodiscard]] Pinhole pinhole_about(const Camera& camera);

// Whether the image, enlarged about its middle by a factor, contains a point in the water without a
// port.
[[nodiscard]] bool is_in_view(const Camera& camera, const Eigen::Vector3d& point_m, double factor);

// Lenses of the same signature have the same view. By key, as text.
[[nodiscard]] std::map<std::string, std::string> lens_signature(const Camera& camera);

}  // namespace aphotic
