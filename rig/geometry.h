// SPDX-License-Identifier: BSD-3-Clause
//
// Geometry of a rig for the scene generator: the floor, the pixels' rays, the lamps of an emitter,
// and the transformation to POV-Ray's frame.
//
// Sled frame: x forward, y starboard, z down, origin at the entrance pupil, metres. The world's
// downward direction, seen from a sled with pitch p (bow up) and roll q (starboard down), is
//
//   down = (-sin p, cos p sin q, cos p cos q)
//
// and the floor is the plane through (0, 0, altitude) perpendicular to it. With p > 0 the floor
// falls away forward; with q > 0 it rises to starboard.
//
// POV-Ray is left-handed: its (x, y, z) is our (starboard, forward, down).
#pragma once

#include "rig/rig.h"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace aphotic {

// The scalar T is a number, or a number with derivatives (ceres::Jet).
template <typename T>
struct BasicPlane {
    Eigen::Matrix<T, 3, 1> point_m;
    Eigen::Matrix<T, 3, 1> normal;  // unit, on the side of the water
};
using Plane = BasicPlane<double>;

template <typename T>
[[nodiscard]] BasicPlane<T> floor_plane(const T& altitude_m,
                                        const T& pitch_rad,
                                        const T& roll_rad) {
    using std::cos;
    using std::sin;
    const Eigen::Matrix<T, 3, 1> down(
        -sin(pitch_rad), cos(pitch_rad) * sin(roll_rad), cos(pitch_rad) * cos(roll_rad));
    return {.point_m = {T(0.0), T(0.0), altitude_m}, .normal = -down.normalized()};
}
[[nodiscard]] Plane floor_plane(const Sled& sled);

// Height of a point above the floor, measured along its normal [m].
[[nodiscard]] double height_above(const Plane& floor, const Eigen::Vector3d& point_m);

// The ray in water for the point (column, row) of the image: rig/camera/lens.h's, through
// rig/camera/port.h.
[[nodiscard]] WaterRay pixel_ray(const Rig& rig, double column, double row, double lambda_nm);

// Corners of the image, as (column, row), one of which is the farthest point from the axis; a
// single one if all are equal.
[[nodiscard]] std::vector<std::array<double, 2>> corners_to_ask(const Camera& camera);

// An upper bound of the distance from the pupil at which rays of the image enter the water [m].
[[nodiscard]] double port_reach_m(const Rig& rig);

// Distance along the ray to the plane [m]; empty if the ray does not reach it.
[[nodiscard]] std::optional<double> distance_to(const Plane& plane, const WaterRay& ray);

// The floor points that the image sees, on an even grid of `side` x `side` points from corner to
// corner, row by row; empty where it sees no floor.
struct FloorSample {
    Eigen::Vector3d point_m;
    double camera_leg_m;  // in water
};
[[nodiscard]] std::vector<std::optional<FloorSample>> floor_samples(const Rig& rig,
                                                                    std::size_t side);

// From a strobe's position to the farthest point that emits its light [m].
[[nodiscard]] double emitter_reach_m(const Strobe& strobe);

// The number of lamps of an emitter, across x along.
struct LampGrid {
    int across = 1;
    int along = 1;
};

// The coarsest grid whose error for smooth light is within kGridError in water of attenuation K,
// and whose lamps are closer together than kLampSpacing times the distance d from the emitter to
// the floor below it, or to an object that is nearer. A midpoint rule of spacing h errs by h^2
// f''/24. For f = cos^n(theta) cos(i) exp(-K d) / d^2, the lamp moving in the emitter's plane, so
// that cos(theta) d does not change, and k = K d,
//
//   on the floor, by its height d over it          f''/f <= ((k + n + 2)^2 + n + 2) / d^2
//   on a surface facing the lamp, at distance d    f''/f <= ((k + n + 3)^2 + n + 3) / d^2
//
// with the beam's steepest n: k^2 + 6 k + 12 and k^2 + 8 k + 20 for cones of n = 1. For f is a^n H
// exp(-K d) / d^(n + 3), a constant and H the lamp's height over the surface: its curvature is
// largest where the lamp moves straight away from the lit point, and H changes with it (the first)
// or not (the second). So h^2 = 24 kGridError f/f''. The first is reached straight below a vertical
// emitter, the second towards the rim of the lit area. For n = 1, in clear water over a floor,
// kLampSpacing is the narrower, up to k = 1.1. A shadow or cone edge becomes as many steps as there
// are lamps; the curvature of highlights is not included.
[[nodiscard]] LampGrid lamp_grid(const Rig& rig, const Strobe& strobe, double K_per_m);
inline constexpr double kGridError = 1e-4;
inline constexpr double kLampSpacing = 0.011;
// K at the most attenuated of the wavelengths.
[[nodiscard]] double most_attenuation_per_m(const Rig& rig, std::span<const double> lambda_nm);

// Centres of the grid's cells [m], along and across as in the beam's frame.
[[nodiscard]] std::vector<Eigen::Vector3d> lamp_positions_m(const Strobe& strobe, LampGrid grid);

// The least distance of a strobe from a lit surface [m].
inline constexpr double kLeastDistance_m = 0.001;

// Throws InputError, which names the strobe, unless its height above the floor is sufficient and
// all of its lamps are above it, since an emitter may extend below.
void require_over_floor(const Sled& sled, const Strobe& strobe, LampGrid grid);

[[nodiscard]] inline Eigen::Vector3d to_povray(const Eigen::Vector3d& sled) {
    return {sled.y(), sled.x(), sled.z()};
}

}  // namespace aphotic
