// SPDX-License-Identifier: BSD-3-Clause
#include "light/triangle_mesh.h"

#include "base/error.h"

#include <embree3/rtcore.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace aphotic {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

using Device = std::shared_ptr<std::remove_pointer_t<RTCDevice>>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, decltype(&rtcReleaseScene)>;

// Single-threaded: images are spread over threads, their meshes are not.
const Device& device() {
    static const Device kDevice(rtcNewDevice("threads=1,set_affinity=0"), rtcReleaseDevice);
    if (!kDevice) throw RunError("cannot start Embree, which traces rays");
    return kDevice;
}

template <typename Element>
Element* new_buffer(RTCGeometry geometry,
                    RTCBufferType type,
                    RTCFormat format,
                    std::size_t elements) {
    void* const buffer = rtcSetNewGeometryBuffer(
        geometry, type, 0, format, sizeof(Element), std::max<std::size_t>(1, elements));
    if (buffer == nullptr) throw RunError("Embree has no memory for {} corners", elements);
    return static_cast<Element*>(buffer);
}

RTCRay ray_of(const Vector3f& from_m, const Vector3f& way, float least, float most) {
    RTCRay ray{};
    ray.org_x = from_m.x();
    ray.org_y = from_m.y();
    ray.org_z = from_m.z();
    ray.dir_x = way.x();
    ray.dir_y = way.y();
    ray.dir_z = way.z();
    ray.tnear = least;
    ray.tfar = most;
    ray.mask = ~0U;
    return ray;
}

}  // namespace

struct TriangleMesh::Scene {
    Device of = device();
    SceneHandle handle{rtcNewScene(of.get()), rtcReleaseScene};
    const Vector3f* vertices_m = nullptr;
    const std::array<int, 3>* triangles = nullptr;
};

TriangleMesh::TriangleMesh(std::span<const Vector3f> vertices_m,
                           std::span<const std::array<int, 3>> triangles) {
    auto scene = std::make_shared<Scene>();
    RTCGeometry geometry = rtcNewGeometry(scene->of.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = new_buffer<Vector3f>(
        geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices_m.size());
    auto* const corners = new_buffer<std::array<int, 3>>(
        geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles.size());
    std::ranges::copy(vertices_m, vertices);
    std::ranges::copy(triangles, corners);
    if (triangles.empty()) *corners = {0, 0, 0};  // of no area
    scene->vertices_m = vertices;
    scene->triangles = corners;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene->handle.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene->handle.get(), RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene->handle.get());
    scene_ = std::move(scene);
}

bool TriangleMesh::blocks(const Vector3f& from_m, const Vector3f& way, float least) const {
    RTCRay ray = ray_of(from_m, way, least, 1.0F);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_->handle.get(), &context, &ray);
    return ray.tfar < 0.0F;
}

std::optional<double> TriangleMesh::first_hit(const Vector3d& from_m, const Vector3d& way) const {
    RTCRayHit found{
        .ray = ray_of(
            from_m.cast<float>(), way.cast<float>(), 0.0F, std::numeric_limits<float>::infinity()),
        .hit = {}};
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_->handle.get(), &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const auto [a, b, c] = scene_->triangles[found.hit.primID];
    const Vector3d corner_m = scene_->vertices_m[a].cast<double>();
    const Vector3d normal = (scene_->vertices_m[b].cast<double>() - corner_m)
                                .cross(scene_->vertices_m[c].cast<double>() - corner_m);
    const double times = normal.dot(corner_m - from_m) / normal.dot(way);
    // For a triangle seen edge-on, Embree's own distance is more accurate than that to its plane.
    constexpr double kOfFloats = 1e-3;
    const double by_floats = found.ray.tfar;
    return std::abs(times - by_floats) <= kOfFloats * by_floats ? times : by_floats;
}

std::vector<std::array<int, 3>> grid_triangles(const std::vector<int>& vertices,
                                               std::size_t width) {
    std::vector<std::array<int, 3>> triangles;
    const auto add = [&](const std::array<int, 3>& corners) {
        if (std::ranges::min(corners) >= 0) triangles.push_back(corners);
    };
    for (std::size_t here = 0; here + width < vertices.size(); ++here) {
        if (here % width + 1 == width) continue;
        const std::size_t below = here + width;
        add({vertices[here], vertices[here + 1], vertices[below]});
        add({vertices[here + 1], vertices[below + 1], vertices[below]});
    }
    return triangles;
}

}  // namespace aphotic
