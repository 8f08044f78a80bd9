// SPDX-License-Identifier: BSD-3-Clause
#include "rig/geometry.h"

#include "base/error.h"
#include "base/offered.h"
#include "rig/camera/lens.h"
#include "rig/solid.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace aphotic {

using Eigen::Vector3d;

Plane floor_plane(const Sled& sled) {
    return floor_plane(sled.altitude_m, sled.pitch_rad, sled.roll_rad);
}

double height_above(const Plane& floor, const Vector3d& point_m) {
    return floor.normal.dot(point_m - floor.point_m);
}

WaterRay pixel_ray(const Rig& rig, double column, double row, double lambda_nm) {
    const Port& port = rig.camera.port;
    return ray_into_water(port,
                          direction_in_air(rig.camera, column, row),
                          lambda_nm,
                          port ? rig.water.refractive_index(lambda_nm) : 1.0);
}

std::vector<std::array<double, 2>> corners_to_ask(const Camera& camera) {
    const double right = camera.width_px;
    const double bottom = camera.height_px;
    if (!camera.lens && (!camera.port || is_across_axis(*camera.port))) return {{0.0, 0.0}};
    return {{0.0, 0.0}, {right, 0.0}, {0.0, bottom}, {right, bottom}};
}

double port_reach_m(const Rig& rig) {
    if (!rig.camera.port) return 0.0;
    // Rays reach farthest at the corners, and slightly farther in blue or red than in between.
    constexpr double kRoom = 1.05;
    const double middle_nm = 0.5 * (rig.camera.range.first_nm + rig.camera.range.last_nm);
    double reach_m = 0.0;
    for (const auto& [column, row] : corners_to_ask(rig.camera)) {
        reach_m = std::max(reach_m, pixel_ray(rig, column, row, middle_nm).origin_m.norm());
    }
    return kRoom * reach_m;
}

std::optional<double> distance_to(const Plane& plane, const WaterRay& ray) {
    const double approach = -plane.normal.dot(ray.direction);
    if (approach <= 0.0) return std::nullopt;
    const double distance_m = height_above(plane, ray.origin_m) / approach;
    return distance_m > 0.0 ? std::optional(distance_m) : std::nullopt;
}

std::vector<std::optional<FloorSample>> floor_samples(const Rig& rig, std::size_t side) {
    const Plane floor = floor_plane(rig.sled);
    const double middle_nm = 0.5 * (rig.camera.range.first_nm + rig.camera.range.last_nm);
    const double steps = static_cast<double>(side) - 1.0;
    std::vector<std::optional<FloorSample>> samples;
    for (std::size_t j = 0; j < side; ++j) {
        for (std::size_t i = 0; i < side; ++i) {
            const double column = rig.camera.width_px * (static_cast<double>(i) / steps);
            const double row = rig.camera.height_px * (static_cast<double>(j) / steps);
            const WaterRay ray = pixel_ray(rig, column, row, middle_nm);
            const auto distance_m = distance_to(floor, ray);
            samples.emplace_back();
            if (!distance_m) continue;
            samples.back() = {.point_m = ray.origin_m + *distance_m * ray.direction,
                              .camera_leg_m = *distance_m};
        }
    }
    return samples;
}

double most_attenuation_per_m(const Rig& rig, std::span<const double> lambda_nm) {
    double most_per_m = 0.0;
    for (const double nm : lambda_nm) {
        most_per_m = std::max(most_per_m, rig.water.attenuation_per_m(nm));
    }
    return most_per_m;
}

double emitter_reach_m(const Strobe& strobe) {
    if (!strobe.emitter) return 0.0;
    return 0.5 * std::hypot(strobe.emitter->across_m, strobe.emitter->along_m);
}

LampGrid lamp_grid(const Rig& rig, const Strobe& strobe, double K_per_m) {
    if (!strobe.emitter) return {};
    const double height_m = height_above(floor_plane(rig.sled), strobe.position_m);
    const double throw_m = least_throw_m(rig, strobe, strobe.position_m);
    constexpr double kSecondOrder = 24.0;
    const auto spacing_for = [](double d_m, double most_bend) {
        return d_m * std::sqrt(kSecondOrder * kGridError / most_bend);
    };
    // (k + m)^2 + m
    const auto bend = [](double k, double m) { return (k + 2.0 * m) * k + m * (m + 1.0); };
    const double m_of_floor = steepest_exponent(strobe.beam) + 2.0;
    double spacing_m = std::min(kLampSpacing * throw_m,
                                spacing_for(height_m, bend(K_per_m * height_m, m_of_floor)));
    if (throw_m < height_m) {
        spacing_m =
            std::min(spacing_m, spacing_for(throw_m, bend(K_per_m * throw_m, m_of_floor + 1.0)));
    }
    constexpr double kMostLamps = 1e6;  // far more than a scene can hold: refused later
    const auto lamps = [&](double size_m) {
        return static_cast<int>(std::clamp(std::ceil(size_m / spacing_m), 1.0, kMostLamps));
    };
    return {.across = lamps(strobe.emitter->across_m), .along = lamps(strobe.emitter->along_m)};
}

std::vector<Vector3d> lamp_positions_m(const Strobe& strobe, LampGrid grid) {
    if (!strobe.emitter) return {strobe.position_m};
    const BeamFrame frame = frame_about(strobe.axis);
    std::vector<Vector3d> positions_m;
    for (int i = 0; i < grid.across; ++i) {
        for (int j = 0; j < grid.along; ++j) {
            const double u = (i + 0.5) / grid.across - 0.5;
            const double v = (j + 0.5) / grid.along - 0.5;
            positions_m.emplace_back(strobe.position_m +
                                     u * strobe.emitter->across_m * frame.across +
                                     v * strobe.emitter->along_m * frame.along);
        }
    }
    return positions_m;
}

void require_over_floor(const Sled& sled, const Strobe& strobe, LampGrid grid) {
    const Plane floor = floor_plane(sled);
    const double height_m = height_above(floor, strobe.position_m);
    if (height_m < kLeastDistance_m) {
        throw InputError("strobe '{}' is {} m {} the sea floor; allowed: at least {} m above it",
                         strobe.name,
                         height_m < 0.0 ? fmt::format("{:.4f}", -height_m)
                                        : fmt::format("{}", at_most(height_m, 4)),
                         height_m < 0.0 ? "below" : "above",
                         kLeastDistance_m);
    }
    for (const Vector3d& lamp_m : lamp_positions_m(strobe, grid)) {
        if (height_above(floor, lamp_m) > 0.0) continue;
        throw InputError("strobe '{}' has a lamp at or below the sea floor, {:.4f} m below it",
                         strobe.name,
                         -height_above(floor, lamp_m));
    }
}

}  // namespace aphotic
