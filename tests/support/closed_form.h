// SPDX-License-Identifier: BSD-3-Clause
//
// The radiance that a rig's pixel must have, by the formulas of docs/background/physics.md, written
// for the tests and from nothing but the rig: no geometry or light of the code under test.
//
//   L = sum over strobes, cones, lamps of  Phi P A_k cos(theta) / (N d^2)
//         (rho cos(i) + phong max(0, r.l)^size) / pi  exp(-K (d + r))
//
// Of a beam that is no sum of sharp cones, A_k cos(theta) is what rig/beam says, whose tests hold
// it to formulas of their own.
#pragma once

#include "rig/beam/beam.h"
#include "rig/rig.h"
#include "spectral/refractive_index.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace aphotic::closed_form {

using Vector = std::array<double, 3>;  // sled frame: forward, starboard, down

inline double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector plus(const Vector& a, double factor, const Vector& b) {
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
inline double length(const Vector& a) {
    return std::sqrt(dot(a, a));
}
inline Vector unit(const Vector& a) {
    return plus({0, 0, 0}, 1.0 / length(a), a);
}
inline Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Answer {
    double radiance = 0.0;
    // How close the pixel is to the nearest edge of any cone [rad].
    double edge_rad = std::numeric_limits<double>::infinity();
};

// The world's "down" in the sled's frame: the third row of Ry(pitch) Rx(roll), which turns the
// sled's axes into the world's.
inline Vector world_down(const Sled& sled) {
    return {-std::sin(sled.pitch_rad),
            std::cos(sled.pitch_rad) * std::sin(sled.roll_rad),
            std::cos(sled.pitch_rad) * std::cos(sled.roll_rad)};
}

struct Ray {
    Vector origin{};
    Vector direction{};
};

// In cylinder coordinates about the axis: the angle to it changes by Snell, the azimuth stays.
inline Ray camera_ray(const Rig& rig, int column, int row, double lambda_nm) {
    const double forward = (rig.camera.height_px / 2.0 - (row + 0.5)) * rig.camera.pixel_pitch_m;
    const double starboard = (column + 0.5 - rig.camera.width_px / 2.0) * rig.camera.pixel_pitch_m;
    if (!rig.camera.port) return {{0, 0, 0}, unit({forward, starboard, rig.camera.focal_length_m})};
    const double azimuth = std::atan2(starboard, forward);
    const double air = std::atan2(std::hypot(forward, starboard), rig.camera.focal_length_m);
    const PortWindow& port = *rig.camera.port;
    const double glass = std::asin(std::sin(air) / port.glass.index(lambda_nm));
    const double water = std::asin(
        std::sin(air) / seawater_index(lambda_nm, rig.water.salinity_psu, rig.water.temperature_c));
    const double offset = port.distance_m * std::tan(air) + port.thickness_m * std::tan(glass);
    return {{offset * std::cos(azimuth),
             offset * std::sin(azimuth),
             port.distance_m + port.thickness_m},
            {std::sin(water) * std::cos(azimuth),
             std::sin(water) * std::sin(azimuth),
             std::cos(water)}};
}

// How close a direction is to where the beam has an edge, if that is a circle; 0 where it is within
// a rounding of any other.
inline double edge_rad(const Beam& beam, const BeamFrame& frame, const Eigen::Vector3d& towards) {
    double nearest_rad = std::numeric_limits<double>::infinity();
    const double theta_rad = std::atan2(frame.axis.cross(towards).norm(), frame.axis.dot(towards));
    for (const double edge : edges_rad(beam)) {
        nearest_rad = std::min(nearest_rad, std::abs(theta_rad - edge));
    }
    if (!has_rim(beam)) return nearest_rad;
    constexpr double kRounding = 1e-9;
    const bool is_within = is_within_rim(beam, frame, towards);
    for (const double off : {-kRounding, kRounding}) {
        for (const Eigen::Vector3d& way : {frame.along, frame.across}) {
            const Eigen::Vector3d beside = towards + off * towards.norm() * way;
            if (is_within_rim(beam, frame, beside) != is_within) return 0.0;
        }
    }
    return nearest_rad;
}

// across x along: how many lamps stand for an emitter.
inline Answer radiance(
    const Rig& rig, int column, int row, double lambda_nm, int across = 1, int along = 1) {
    Answer answer;
    const Ray ray = camera_ray(rig, column, row, lambda_nm);
    const Vector down = world_down(rig.sled);
    const double below = dot(plus({0, 0, rig.sled.altitude_m}, -1.0, ray.origin), down);
    const double approach = dot(ray.direction, down);
    if (approach <= 0.0) return answer;
    const double r = below / approach;
    const Vector point = plus(ray.origin, r, ray.direction);
    const double absorbed_per_m =
        rig.water.multiple > 0.0 ? rig.water.multiple * rig.water.absorption_per_m.at(lambda_nm)
                                 : 0.0;
    const double K_per_m = absorbed_per_m + rig.water.uniform_loss_per_m;
    const double rho = rig.seafloor.reflectance.at(lambda_nm);
    // The view reflected at the floor, for the highlight.
    const Vector mirrored = plus(ray.direction, -2.0 * dot(ray.direction, down), down);

    for (const Strobe& strobe : rig.strobes) {
        const Vector axis{strobe.axis.x(), strobe.axis.y(), strobe.axis.z()};
        const Vector place{strobe.position_m.x(), strobe.position_m.y(), strobe.position_m.z()};
        const bool has_size = strobe.emitter.has_value();
        // "Along" is forward as seen in the emitter's plane, "across" to its right.
        const Vector ahead = unit(plus({1, 0, 0}, -axis[0], axis));
        const Vector right = cross(axis, ahead);
        const int n_across = has_size ? across : 1;
        const int n_along = has_size ? along : 1;
        for (int lamp = 0; lamp < n_across * n_along; ++lamp) {
            Vector from = place;
            if (has_size) {
                const int a = lamp % n_across;
                const int b = lamp / n_across;
                from = plus(
                    from, ((2 * a + 1.0) / n_across - 1.0) * strobe.emitter->across_m / 2.0, right);
                from = plus(
                    from, ((2 * b + 1.0) / n_along - 1.0) * strobe.emitter->along_m / 2.0, ahead);
            }
            const Vector path = plus(point, -1.0, from);
            const double d = length(path);
            const double cos_theta = dot(path, axis) / d;
            const double cos_i = dot(path, down) / d;
            const double theta = std::atan2(length(cross(path, axis)), dot(path, axis));
            const double highlight =
                rig.seafloor.phong *
                std::pow(std::max(0.0, -dot(mirrored, path) / d), rig.seafloor.phong_size);
            const bool is_sum_of_sharp_cones =
                std::holds_alternative<std::monostate>(strobe.beam.pattern) &&
                !strobe.beam.window && std::ranges::all_of(strobe.beam.cones, [](const Cone& cone) {
                    return cone.edge_rad == 0.0;
                });
            if (!is_sum_of_sharp_cones) {
                const auto eigen = [](const Vector& v) {
                    return Eigen::Vector3d(v[0], v[1], v[2]);
                };
                const BeamFrame frame{eigen(axis), eigen(ahead), eigen(right)};
                answer.edge_rad =
                    std::min(answer.edge_rad, edge_rad(strobe.beam, frame, eigen(path)));
                if (cos_i <= 0.0) continue;
                answer.radiance += strobe.spectrum.at(lambda_nm) * strobe.power *
                                   intensity_towards(strobe.beam, frame, eigen(path)) /
                                   (n_across * n_along * d * d) * (rho * cos_i + highlight) /
                                   std::numbers::pi * std::exp(-K_per_m * (d + r));
                continue;
            }
            for (const Cone& cone : strobe.beam.cones) {
                answer.edge_rad = std::min(answer.edge_rad, std::abs(theta - cone.half_angle_rad));
                if (theta > cone.half_angle_rad || cos_theta <= 0.0 || cos_i <= 0.0) continue;
                const double n = cone.exponent;
                const double flux_of_lobe =
                    n == 1.0 ? std::numbers::pi * std::pow(std::sin(cone.half_angle_rad), 2.0)
                             : 2.0 * std::numbers::pi / (n + 1.0) *
                                   (1.0 - std::pow(std::cos(cone.half_angle_rad), n + 1.0));
                const double A = strobe.beam.weights == ConeWeights::Flux
                                     ? cone.weight / flux_of_lobe
                                     : cone.weight;
                answer.radiance += strobe.spectrum.at(lambda_nm) * strobe.power * A *
                                   std::pow(cos_theta, n) / (n_across * n_along * d * d) *
                                   (rho * cos_i + highlight) / std::numbers::pi *
                                   std::exp(-K_per_m * (d + r));
            }
        }
    }
    return answer;
}

}  // namespace aphotic::closed_form
