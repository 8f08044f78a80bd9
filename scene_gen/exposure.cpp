// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/exposure.h"

#include "rig/camera/lens.h"
#include "rig/geometry.h"
#include "rig/solid.h"
#include "spectral/manifest.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kGridOfFloor = 33;  // points along each side of the image
constexpr double kMarginView = 1.5;       // a point this far outside the image still counts
constexpr int kColourLimitLog2 = 120;     // colours are single precision: 2^128 overflows

// The largest angle to another point of the same grid cell, seen from a place.
double reach_rad(const std::vector<Vector3d>& neighbours_m,
                 const Vector3d& at_m,
                 const Vector3d& from_m) {
    double reach = 0.0;
    for (const Vector3d& next_m : neighbours_m) {
        reach = std::max(reach, angle_between(at_m - from_m, next_m - from_m));
    }
    return reach;
}

// cos^size of the angle off the mirrored ray, less the margin.
double widened_highlight(const Seafloor& floor, double angle_rad, double margin_rad) {
    const double cos_angle = std::cos(std::max(0.0, angle_rad - margin_rad));
    return cos_angle > 0.0 ? floor.phong * std::pow(cos_angle, floor.phong_size) : 0.0;
}

// From the strobe's nearest lamp, for a grid of them.
double least_object_distance_m(const Strobe& strobe, const Object& object) {
    constexpr LampGrid kGridOfLamps{.across = 9, .along = 9};
    double least_m = std::numeric_limits<double>::infinity();
    for (const Vector3d& lamp_m : lamp_positions_m(strobe, kGridOfLamps)) {
        least_m = std::min(least_m, distance_m(object.shape, lamp_m));
    }
    return std::max(kLeastDistance_m, least_m);
}

}  // namespace

RadianceBound::RadianceBound(const Rig& rig) : rig_(rig) {
    const std::vector<std::optional<FloorSample>> samples = floor_samples(rig, kGridOfFloor);
    const auto neighbours_of = [&](std::size_t index) {
        std::vector<Vector3d> neighbours_m;
        const bool is_last_of_row = index % kGridOfFloor == kGridOfFloor - 1;
        for (const std::size_t step : {std::size_t{1}, kGridOfFloor}) {
            if (step == 1 && is_last_of_row) continue;
            if (index + step >= samples.size() || !samples[index + step]) continue;
            neighbours_m.push_back(samples[index + step]->point_m);
        }
        return neighbours_m;
    };
    for (std::size_t index = 0; index < samples.size(); ++index) {
        if (!samples[index]) continue;
        add_point(samples[index]->point_m, samples[index]->camera_leg_m, neighbours_of(index));
    }
    // The light of a lamp close to the floor can peak between the grid's points: add the point
    // below it, as far from its neighbours as the nearest grid point is from its own.
    const Plane floor = floor_plane(rig.sled);
    for (const Strobe& strobe : rig.strobes) {
        const Vector3d foot_m =
            strobe.position_m - height_above(floor, strobe.position_m) * floor.normal;
        if (!is_in_view(rig.camera, foot_m, kMarginView)) continue;
        double nearest_m = std::numeric_limits<double>::infinity();
        std::vector<Vector3d> neighbours_m;
        for (std::size_t index = 0; index < samples.size(); ++index) {
            if (!samples[index] || (samples[index]->point_m - foot_m).norm() >= nearest_m) continue;
            nearest_m = (samples[index]->point_m - foot_m).norm();
            neighbours_m = {samples[index]->point_m};
            for (const Vector3d& next_m : neighbours_of(index)) {
                neighbours_m.push_back(foot_m + next_m - samples[index]->point_m);
                neighbours_m.push_back(foot_m - next_m + samples[index]->point_m);
            }
        }
        const double port_m = std::max(2.0 * front_m(rig.camera.port), port_reach_m(rig));
        const double camera_leg_m = std::max(0.0, foot_m.norm() - port_m);
        add_point(foot_m, camera_leg_m, neighbours_m);
    }
    for (const Object& object : rig.objects) {
        if (may_be_in_view(rig, object)) add_object(object);
    }
}

void RadianceBound::add_point(const Vector3d& point_m,
                              double camera_leg_m,
                              const std::vector<Vector3d>& neighbours_m) {
    // Behind a port the ray starts beside the pupil.
    constexpr double kPortMarginRad = 0.1;
    const Plane floor = floor_plane(rig_.sled);
    const Vector3d view = point_m.normalized();
    const Vector3d mirrored = view - 2.0 * view.dot(floor.normal) * floor.normal;
    const double camera_reach_rad = reach_rad(neighbours_m, point_m, Vector3d::Zero()) +
                                    (rig_.camera.port ? kPortMarginRad : 0.0);
    std::vector<Lit> lit;
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const Strobe& strobe = rig_.strobes[s];
        const Vector3d towards = point_m - strobe.position_m;
        const double d_m = towards.norm();
        const double margin_rad = reach_rad(neighbours_m, point_m, strobe.position_m);
        const double intensity =
            most_intensity(strobe.beam, frame_about(strobe.axis), towards, margin_rad);
        const double irradiance = strobe.power * intensity / (d_m * d_m);
        const double cos_incidence = std::max(0.0, -floor.normal.dot(towards) / d_m);
        const double highlight = widened_highlight(
            rig_.seafloor, angle_between(mirrored, -towards), margin_rad + camera_reach_rad);
        lit.push_back({.strobe = s,
                       .path_m = d_m + camera_leg_m,
                       .diffuse_per_m2 = irradiance * cos_incidence / std::numbers::pi,
                       .specular_per_m2 = irradiance * highlight / std::numbers::pi});
    }
    points_.push_back({.reflectance = &rig_.seafloor.reflectance, .lit = std::move(lit)});
}

void RadianceBound::add_object(const Object& object) {
    const double camera_leg_m =
        std::max(0.0, distance_m(object.shape, Vector3d::Zero()) - port_reach_m(rig_));
    std::vector<Lit> lit;
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const Strobe& strobe = rig_.strobes[s];
        double intensity = 0.0;
        for (const Beam& part : parts_of(strobe.beam)) {
            if (may_light(strobe, part, object)) intensity += most_intensity(part);
        }
        if (intensity == 0.0) continue;
        const double d_m = least_object_distance_m(strobe, object);
        const double irradiance = strobe.power * intensity / (d_m * d_m);
        lit.push_back({.strobe = s,
                       .path_m = d_m + camera_leg_m,
                       .diffuse_per_m2 = irradiance / std::numbers::pi,
                       .specular_per_m2 = irradiance * object.phong / std::numbers::pi});
    }
    points_.push_back({.reflectance = &object.reflectance, .lit = std::move(lit)});
}

double RadianceBound::at(double lambda_nm) const {
    const double attenuation_per_m = rig_.water.attenuation_per_m(lambda_nm);
    double bound = 0.0;
    for (const LitPoint& point : points_) {
        const double reflectance = point.reflectance->at(lambda_nm);
        double radiance = 0.0;
        for (const Lit& lit : point.lit) {
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
    const double least = -kMostExposureLog2;
    const double most = kMostExposureLog2;
    return static_cast<int>(std::clamp(std::min(for_the_frame, for_the_colour), least, most));
}

}  // namespace aphotic
