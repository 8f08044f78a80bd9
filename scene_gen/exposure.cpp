// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/exposure.h"

#include "scene_gen/geometry.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kGrid = 33;      // points along each side of the image
constexpr double kMarginView = 1.5;    // a point this far outside the image may still count
constexpr int kColourLimitLog2 = 120;  // colours are single precision: 2^128 overflows

double angle_between(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

bool may_be_in_view(const Camera& camera, const Vector3d& point_m) {
    const double reach = kMarginView * 0.5 * camera.pixel_pitch_m / camera.focal_length_m;
    return point_m.z() > 0.0 && std::abs(point_m.x()) <= reach * camera.height_px * point_m.z() &&
           std::abs(point_m.y()) <= reach * camera.width_px * point_m.z();
}

// Intensity towards theta per unit of lamp power, over all cones, each widened by the margin.
double widened_intensity(const Beam& beam, double theta_rad, double margin_rad) {
    double intensity = 0.0;
    for (const Cone& cone : beam.cones) {
        if (theta_rad > cone.half_angle_rad + margin_rad) continue;
        intensity +=
            axial_intensity(cone, beam.weights) * std::cos(std::max(0.0, theta_rad - margin_rad));
    }
    return std::max(0.0, intensity);
}

}  // namespace

RadianceBound::RadianceBound(const Rig& rig) : rig_(rig) {
    const Plane floor = floor_plane(rig.sled);
    const std::vector<std::optional<FloorSample>> points = floor_samples(rig, kGrid);
    for (std::size_t index = 0; index < points.size(); ++index) {
        if (!points[index]) continue;
        double margin_rad = 0.0;
        for (const std::size_t step : {std::size_t{1}, kGrid}) {
            const bool is_last_of_row = index % kGrid == kGrid - 1;
            if (step == 1 && is_last_of_row) continue;
            if (index + step >= points.size() || !points[index + step]) continue;
            for (const Strobe& strobe : rig.strobes) {
                margin_rad =
                    std::max(margin_rad,
                             angle_between(points[index]->point_m - strobe.position_m,
                                           points[index + step]->point_m - strobe.position_m));
            }
        }
        add_point(points[index]->point_m, points[index]->camera_leg_m, margin_rad);
    }
    // A lamp close to the floor can peak between the grid's points: add its foot.
    for (const Strobe& strobe : rig.strobes) {
        const Vector3d foot_m =
            strobe.position_m - height_above(floor, strobe.position_m) * floor.normal;
        if (may_be_in_view(rig.camera, foot_m)) {
            const double port_m =
                rig.camera.port ? rig.camera.port->distance_m + rig.camera.port->thickness_m : 0.0;
            add_point(foot_m, std::max(0.0, foot_m.norm() - 2.0 * port_m), std::numbers::pi);
        }
    }
}

void RadianceBound::add_point(const Vector3d& point_m,
                              double camera_leg_m,
                              double cone_margin_rad) {
    const Plane floor = floor_plane(rig_.sled);
    LitPoint lit;
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const Strobe& strobe = rig_.strobes[s];
        const Vector3d towards = point_m - strobe.position_m;
        const double d_m = towards.norm();
        const double theta_rad = angle_between(strobe.axis, towards);
        const double intensity = widened_intensity(strobe.beam, theta_rad, cone_margin_rad);
        const double irradiance = strobe.power * intensity / (d_m * d_m);
        const double cos_incidence = std::max(0.0, -floor.normal.dot(towards) / d_m);
        lit.push_back({.strobe = s,
                       .path_m = d_m + camera_leg_m,
                       .diffuse_per_m2 = irradiance * cos_incidence / std::numbers::pi,
                       .specular_per_m2 = irradiance * rig_.seafloor.phong / std::numbers::pi});
    }
    points_.push_back(std::move(lit));
}

double RadianceBound::at(double lambda_nm) const {
    const double attenuation_per_m = rig_.water.attenuation_per_m(lambda_nm);
    const double reflectance = rig_.seafloor.reflectance.at(lambda_nm);
    double bound = 0.0;
    for (const LitPoint& point : points_) {
        double radiance = 0.0;
        for (const Lit& lit : point) {
            radiance += rig_.strobes[lit.strobe].spectrum.at(lambda_nm) *
                        (reflectance * lit.diffuse_per_m2 + lit.specular_per_m2) *
                        std::exp(-attenuation_per_m * lit.path_m);
        }
        bound = std::max(bound, radiance);
    }
    return bound;
}

int exposure_log2(double radiance_bound, double brightest_colour, int target_log2) {
    if (!(radiance_bound > 0.0)) return 0;
    const double for_the_frame = std::floor(target_log2 - std::log2(radiance_bound));
    const double for_the_colour = std::floor(kColourLimitLog2 - std::log2(brightest_colour));
    return static_cast<int>(std::min(for_the_frame, for_the_colour));
}

}  // namespace aphotic
