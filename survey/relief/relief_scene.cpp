// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/relief_scene.h"

#include "image/image_size.h"

#include <limits>
#include <vector>

namespace aphotic {

using Eigen::Vector3d;

namespace {

Vector3d in_world(const Vector3d& vertex_m, ReliefAxes axes) {
    if (axes == ReliefAxes::NorthEastDown) return vertex_m;
    const double down = axes == ReliefAxes::EastNorthUp ? -vertex_m.z() : vertex_m.z();
    return {vertex_m.y(), vertex_m.x(), down};
}

// Around the vertices used by triangles.
Eigen::AlignedBox3d box_around(const Mesh& mesh, ReliefAxes axes) {
    Eigen::AlignedBox3d box;
    for (const auto& corners : mesh.triangles)
        for (const int corner : corners)
            box.extend(in_world(mesh.vertices_m[size_of(corner)], axes));
    return box;
}

TriangleMesh mesh_about(const Vector3d& middle_m, const Mesh& mesh, ReliefAxes axes) {
    std::vector<Eigen::Vector3f> vertices_m;
    vertices_m.reserve(mesh.vertices_m.size());
    for (const Vector3d& vertex_m : mesh.vertices_m)
        vertices_m.emplace_back((in_world(vertex_m, axes) - middle_m).cast<float>());
    return {vertices_m, mesh.triangles};
}

}  // namespace

ReliefScene::ReliefScene(const Mesh& mesh, ReliefAxes axes)
    : box_m_(box_around(mesh, axes)), mesh_(mesh_about(box_m_.center(), mesh, axes)) {}

std::optional<double> ReliefScene::floor_at(double north_m, double east_m) const {
    constexpr double kAbove_m = 1.0;
    const Vector3d from_m(north_m, east_m, box_m_.min().z() - kAbove_m);
    const auto down_m = mesh_.first_hit(from_m - box_m_.center(), Vector3d::UnitZ());
    if (!down_m) return std::nullopt;
    return from_m.z() + *down_m;
}

std::optional<double> ReliefScene::depth_m(const CameraStation& camera, const WaterRay& ray) const {
    const auto length_m = mesh_.first_hit(
        camera.pupil_m + camera.turn * ray.origin_m - box_m_.center(), camera.turn * ray.direction);
    if (!length_m) return std::nullopt;
    const double depth = ray.origin_m.z() + *length_m * ray.direction.z();
    return depth > 0.0 && depth <= kMostDepth ? std::optional(depth) : std::nullopt;
}

DepthMap ReliefScene::depth_map(const CameraStation& camera,
                                const PixelRay& ray,
                                int width_px,
                                int height_px) const {
    constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
    DepthMap map{.width_px = width_px, .height_px = height_px, .depth_m = {}};
    map.depth_m.reserve(size_of(width_px) * size_of(height_px));
    for (int row = 0; row < height_px; ++row)
        for (int column = 0; column < width_px; ++column)
            map.depth_m.push_back(
                static_cast<float>(depth_m(camera, ray(column + 0.5, row + 0.5)).value_or(kHole)));
    return map;
}

bool ReliefScene::is_seen(const CameraStation& camera,
                          const PixelRay& ray,
                          int width_px,
                          int height_px) const {
    constexpr int kAcross = 9;
    const auto place = [](int i, int pixels) { return (i + 0.5) / kAcross * pixels; };
    for (int row = 0; row < kAcross; ++row)
        for (int column = 0; column < kAcross; ++column)
            if (depth_m(camera, ray(place(column, width_px), place(row, height_px)))) return true;
    return false;
}

}  // namespace aphotic
