// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/floor_relief.h"

#include "base/error.h"
#include "rig/geometry.h"
#include "survey/relief/local_planes.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

using Eigen::Vector3d;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// Along the ray to where Z, or |P|, has this value: its origin is within a port.
double length_to(const WaterRay& ray, double depth_m, DepthIs is) {
    if (is == DepthIs::AlongAxis) return (depth_m - ray.origin_m.z()) / ray.direction.z();
    const double along = ray.origin_m.dot(ray.direction);
    return -along + std::sqrt(along * along + depth_m * depth_m - ray.origin_m.squaredNorm());
}

Vector3d point_on(const WaterRay& ray, double length_m) {
    return ray.origin_m + length_m * ray.direction;
}

std::vector<InversePlace> places_of(const DepthMap& map, DepthIs is, const ReliefMapMaker& rays) {
    std::vector<InversePlace> places;
    places.reserve(map.depth_m.size());
    for (int row = 0; row < map.height_px; ++row) {
        for (int column = 0; column < map.width_px; ++column) {
            const float depth_m = map.depth_m[places.size()];
            const WaterRay ray = rays.ray(column + 0.5, row + 0.5);
            // A hole takes the place of the ray's direction, which is near enough behind a port.
            const double length_m = length_to(ray, std::isfinite(depth_m) ? depth_m : 1.0, is);
            const Vector3d point_m = point_on(ray, length_m);
            const Vector3d place = point_m / point_m.z();
            places.push_back(
                {.place = {static_cast<float>(place.x()), static_cast<float>(place.y())},
                 .inverse_per_m = std::isfinite(depth_m) && point_m.z() > 0.0
                                      ? static_cast<float>(1.0 / point_m.z())
                                      : kUnknown});
        }
    }
    return places;
}

double pixel_rad(const ReliefMapMaker& rays, int width_px, int height_px) {
    const double column = 0.5 * width_px;
    const double row = 0.5 * height_px;
    return angle_between(rays.ray(column, row).direction, rays.ray(column + 1.0, row).direction);
}

// From some rows in the middle of the image.
double roughness_of(const std::vector<InversePlace>& places, int width_px) {
    const std::size_t eighth = places.size() / static_cast<std::size_t>(width_px) / 8;
    const auto row = [&](std::size_t n) {
        return places.begin() + static_cast<std::ptrdiff_t>(n * static_cast<std::size_t>(width_px));
    };
    const std::vector<InversePlace> middle =
        eighth == 0 ? places : std::vector<InversePlace>(row(3 * eighth), row(5 * eighth));
    const double found = LocalPlanes(middle, width_px, kLeastBlock_px).roughness();
    return found > 0.0 || eighth == 0 ? found
                                      : LocalPlanes(places, width_px, kLeastBlock_px).roughness();
}

struct ReliefWriter {
    const std::vector<InversePlace>& places;
    const ReliefMapMaker& rays;
    const std::optional<Sled>& floor;
    NormalsFrom normals;

    // The point on the pixel's line of sight at this depth.
    [[nodiscard]] Vector3d point_at(int column, int row, std::size_t pixel, double depth_m) const {
        if (!rays.has_port()) {
            const Eigen::Vector2d place = places[pixel].place.cast<double>();
            return {depth_m * place.x(), depth_m * place.y(), depth_m};
        }
        const WaterRay ray = rays.ray(column + 0.5, row + 0.5);
        return point_on(ray, length_to(ray, depth_m, DepthIs::AlongAxis));
    }
    // On the plane at the pixel's place, or at its own range.
    void put(int column, int row, const LocalPlane& plane, Relief& relief) const {
        const std::size_t pixel = relief.at(column, row);
        const InversePlace& here = places[pixel];
        double inverse_per_m = plane.inverse_at(here.place);
        const double off_per_m = std::abs(inverse_per_m - here.inverse_per_m);
        constexpr double kRoundingOfFloats = 1e-6;
        if (off_per_m > std::max(kOffPlane * plane.rms_per_m, kRoundingOfFloats * inverse_per_m))
            inverse_per_m = here.inverse_per_m;
        if (!(inverse_per_m > 0.0)) return;
        relief.point_m[pixel] = point_at(column, row, pixel, 1.0 / inverse_per_m).cast<float>();
        relief.normal[pixel] =
            (normals == NormalsFrom::Floor ? floor_plane(*floor).normal : plane.normal())
                .cast<float>();
    }
    void put_floor(int column, int row, Relief& relief) const {
        if (!floor) return;
        const std::size_t pixel = relief.at(column, row);
        const WaterRay ray = rays.ray(column + 0.5, row + 0.5);
        const Plane plane = floor_plane(*floor);
        const auto length_m = distance_to(plane, ray);
        if (!length_m) return;
        relief.point_m[pixel] = point_on(ray, *length_m).cast<float>();
        relief.normal[pixel] = plane.normal.cast<float>();
    }
};

}  // namespace

nlohmann::ordered_json to_json(const DepthMaps& maps) {
    if (maps.mesh)
        return {{"axes", kReliefAxesWords.at(static_cast<std::size_t>(maps.mesh->axes))},
                {"placed_by", maps.mesh->is_by_depth ? "depth" : "altitude"}};
    return {{"unit_m", maps.unit_m ? nlohmann::ordered_json(*maps.unit_m) : nullptr},
            {"is", maps.is == DepthIs::AlongAxis ? "axis" : "ray"},
            {"normals", maps.normals == NormalsFrom::Depth ? "depth" : "floor"}};
}

FloorRelief floor_relief(const DepthMap& map,
                         DepthIs depth_is,
                         NormalsFrom normals,
                         const ReliefMapMaker& rays,
                         const std::optional<Sled>& floor) {
    constexpr int kHoleBlocks = 90;
    const std::size_t pixels = map.depth_m.size();
    const std::vector<InversePlace> places = places_of(map, depth_is, rays);
    const auto is_hole = [&](std::size_t pixel) {
        return !std::isfinite(places[pixel].inverse_per_m);
    };
    FloorRelief found{.relief = {.width_px = map.width_px,
                                 .height_px = map.height_px,
                                 .point_m = std::vector<Eigen::Vector3f>(
                                     pixels, Eigen::Vector3f::Constant(kUnknown)),
                                 .normal = std::vector<Eigen::Vector3f>(pixels)},
                      .filled = std::vector<std::uint8_t>(pixels),
                      .roughness = roughness_of(places, map.width_px)};
    std::size_t holes = 0;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
        holes += found.filled[pixel] = is_hole(pixel) ? 1 : 0;
    if (holes == pixels)
        throw InputError("found no depth in any of {} pixels of its depth map; allowed: some",
                         pixels);
    const int block_px =
        block_for(found.roughness, pixel_rad(rays, map.width_px, map.height_px), map.width_px);
    const LocalPlanes planes(places, map.width_px, block_px);
    std::optional<LocalPlanes> over_holes;
    if (holes > 0)
        over_holes.emplace(places, map.width_px, std::max(block_px, map.width_px / kHoleBlocks));
    ReliefWriter writer{.places = places, .rays = rays, .floor = floor, .normals = normals};
    for (int row = 0; row < map.height_px; ++row) {
        for (int column = 0; column < map.width_px; ++column) {
            const std::size_t pixel = found.relief.at(column, row);
            const auto plane = (is_hole(pixel) ? *over_holes : planes).at(column, row);
            if (plane)
                writer.put(column, row, *plane, found.relief);
            else
                writer.put_floor(column, row, found.relief);
        }
    }
    return found;
}

}  // namespace aphotic
