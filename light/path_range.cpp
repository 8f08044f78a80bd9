// SPDX-License-Identifier: BSD-3-Clause
#include "light/path_range.h"

#include "rig/geometry.h"
#include "rig/solid.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// Bits of an image coordinate: a pixel of the largest image, and finer than the path depends on.
constexpr int kBits = 20;
// Larger than any path, and rising away from the floor, so that a search finds its way back.
constexpr double kNoFloor_m = 1e30;
// An emitter may be larger than its distance to the floor.
constexpr double kLeastPath_m = 1e-6;

// The path by way of the floor point that (column, row) shows at lambda_nm.
double path_m(const Rig& rig, const Strobe& strobe, double column, double row, double lambda_nm) {
    const Plane floor = floor_plane(rig.sled);
    const WaterRay ray = pixel_ray(rig, column, row, lambda_nm);
    const auto distance_m = distance_to(floor, ray);
    if (!distance_m) return kNoFloor_m * (2.0 + floor.normal.dot(ray.direction));
    const Vector3d point_m = ray.origin_m + *distance_m * ray.direction;
    return *distance_m + (point_m - strobe.position_m).norm();
}

double shortest_path_m(const Rig& rig, const Strobe& strobe, double lambda_nm) {
    const auto along_row = [&](double row) {
        return boost::math::tools::brent_find_minima(
                   [&](double column) { return path_m(rig, strobe, column, row, lambda_nm); },
                   0.0,
                   static_cast<double>(rig.camera.width_px),
                   kBits)
            .second;
    };
    return boost::math::tools::brent_find_minima(
               along_row, 0.0, static_cast<double>(rig.camera.height_px), kBits)
        .second;
}

// The path at which light that falls as exp(-K l) / l^3, no faster than any here, has fallen to
// kDarkShare.
double darkest_path_m(const Rig& rig, double shortest_m) {
    const double K_per_m = rig.water.least_attenuation_per_m();
    double l_m = shortest_m;
    while (std::exp(-K_per_m * (l_m - shortest_m)) * std::pow(shortest_m / l_m, 3) > kDarkShare) {
        constexpr double kStep = 1.02;
        l_m *= kStep;
    }
    return l_m;
}

std::vector<std::array<double, 2>> rim_of(const Camera& camera) {
    // Where rays bend, the longest path may be anywhere along the rim; otherwise at a corner.
    constexpr int kWhereRaysBend = 512;
    const int steps = camera.port || camera.lens ? kWhereRaysBend : 1;
    std::vector<std::array<double, 2>> rim;
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        const double column = share * camera.width_px;
        const double row = share * camera.height_px;
        rim.push_back({column, 0.0});
        rim.push_back({column, static_cast<double>(camera.height_px)});
        rim.push_back({0.0, row});
        rim.push_back({static_cast<double>(camera.width_px), row});
    }
    return rim;
}

// The shortest path via lit floor; 0 if the grid finds none.
double first_lit_path_m(const Rig& rig) {
    constexpr std::size_t kGrid = 65;
    double first_m = std::numeric_limits<double>::infinity();
    for (const auto& sample : floor_samples(rig, kGrid)) {
        if (!sample) continue;
        for (const Strobe& strobe : rig.strobes) {
            const Vector3d towards = sample->point_m - strobe.position_m;
            const bool is_lit =
                strobe.power > 0.0 && reaches(strobe.beam, frame_about(strobe.axis), towards, 0.0);
            if (is_lit) first_m = std::min(first_m, towards.norm() + sample->camera_leg_m);
        }
    }
    return std::isfinite(first_m) ? first_m : 0.0;
}

double farthest_m(const Eigen::AlignedBox3d& box, const Vector3d& from_m) {
    return (box.max() - from_m).cwiseAbs().cwiseMax((box.min() - from_m).cwiseAbs()).norm();
}

void widen_by(const Rig& rig, const Object& object, PathRange& paths) {
    const Eigen::AlignedBox3d box = bounds_m(object.shape);
    const double port_m = port_reach_m(rig);
    const Vector3d pupil_m = Vector3d::Zero();
    const double nearest_leg_m = std::max(0.0, box.exteriorDistance(pupil_m) - port_m);
    const double farthest_leg_m = farthest_m(box, pupil_m) + port_m;
    for (const Strobe& strobe : rig.strobes) {
        const double room_m = emitter_reach_m(strobe);
        const double shortest_m = box.exteriorDistance(strobe.position_m) + nearest_leg_m - room_m;
        const double longest_m = farthest_m(box, strobe.position_m) + farthest_leg_m + room_m;
        paths.shortest_m = std::min(paths.shortest_m, std::max(kLeastPath_m, shortest_m));
        paths.longest_m = std::max(paths.longest_m, longest_m);
    }
}

// For the floor only; infinity and 0 if the image sees none.
PathRange floor_path_range(const Rig& rig) {
    const Camera& camera = rig.camera;
    std::vector<double> wavelengths{std::midpoint(camera.range.first_nm, camera.range.last_nm)};
    if (camera.port) {
        wavelengths.insert(wavelengths.end(), {camera.range.first_nm, camera.range.last_nm});
    }
    PathRange paths{.shortest_m = std::numeric_limits<double>::infinity()};
    for (const Strobe& strobe : rig.strobes) {
        const double room_m = emitter_reach_m(strobe);
        for (const double nm : wavelengths) {
            const double shortest_m = shortest_path_m(rig, strobe, nm);
            if (shortest_m >= kNoFloor_m) continue;
            paths.shortest_m = std::min(paths.shortest_m, shortest_m - room_m);
            for (const auto& [column, row] : rim_of(camera)) {
                const double rim_m = path_m(rig, strobe, column, row, nm);
                paths.has_horizon |= rim_m >= kNoFloor_m;
                if (rim_m < kNoFloor_m) paths.longest_m = std::max(paths.longest_m, rim_m + room_m);
            }
        }
    }
    if (paths.shortest_m == std::numeric_limits<double>::infinity()) return paths;
    paths.shortest_m = std::max(kLeastPath_m, paths.shortest_m / kPathRoom);
    paths.longest_m *= kPathRoom;
    // No farther than light can come from, if the horizon is in view or nearly so.
    const double darkest_m = darkest_path_m(rig, std::max(paths.shortest_m, first_lit_path_m(rig)));
    if (paths.has_horizon || darkest_m < paths.longest_m) paths.longest_m = darkest_m;
    return paths;
}

// The least and greatest of the sleds' values, and 0 between them: paths are shortest for a level
// sled.
std::set<double> extremes(const std::vector<Sled>& sleds, double Sled::*part) {
    const auto [least, most] = std::ranges::minmax(sleds, {}, part);
    return {least.*part, std::clamp(0.0, least.*part, most.*part), most.*part};
}

}  // namespace

PathRange path_range(const Rig& rig) {
    PathRange paths = floor_path_range(rig);
    for (const Object& object : rig.objects) {
        if (may_be_in_view(rig, object)) widen_by(rig, object, paths);
    }
    if (paths.shortest_m == std::numeric_limits<double>::infinity()) return {};
    return paths;
}

std::vector<Sled> corners_of(const std::vector<Sled>& sleds) {
    std::vector<Sled> corners;
    if (sleds.empty()) return corners;
    for (const double altitude_m : extremes(sleds, &Sled::altitude_m)) {
        for (const double pitch_rad : extremes(sleds, &Sled::pitch_rad)) {
            for (const double roll_rad : extremes(sleds, &Sled::roll_rad))
                corners.push_back({altitude_m, pitch_rad, roll_rad});
        }
    }
    return corners;
}

}  // namespace aphotic
