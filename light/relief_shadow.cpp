// SPDX-License-Identifier: BSD-3-Clause
#include "light/relief_shadow.h"

#include "base/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

namespace aphotic {
namespace {

using Device = std::shared_ptr<std::remove_pointer_t<RTCDevice>>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, decltype(&rtcReleaseScene)>;

// Single-threaded: threads work on images, not on their meshes.
const Device& device() {
    static const Device kDevice(rtcNewDevice("threads=1,set_affinity=0"), rtcReleaseDevice);
    if (!kDevice) throw RunError("cannot start Embree, which computes shadows");
    return kDevice;
}

}  // namespace

struct ReliefShadow::Mesh {
    Device of = device();
    Scene scene{rtcNewScene(of.get()), rtcReleaseScene};
};

ReliefShadow::ReliefShadow(const Relief& relief)
    : relief_(relief), step_px_((relief.width_px + kShadowMesh_px - 1) / kShadowMesh_px) {
    const std::vector<int> columns = every(step_px_, relief.width_px);
    const std::vector<int> rows = every(step_px_, relief.height_px);
    std::vector<std::array<unsigned, 3>> triangles;
    const auto add = [&](std::array<unsigned, 3> corners, std::array<std::size_t, 3> pixels) {
        if (std::ranges::all_of(pixels, [&](std::size_t p) { return relief.knows(p); }))
            triangles.push_back(corners);
    };
    const auto width = static_cast<unsigned>(columns.size());
    for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
        for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
            const auto first = static_cast<unsigned>(j) * width + static_cast<unsigned>(i);
            const std::size_t a = relief.at(columns[i], rows[j]);
            const std::size_t b = relief.at(columns[i + 1], rows[j]);
            const std::size_t c = relief.at(columns[i], rows[j + 1]);
            const std::size_t d = relief.at(columns[i + 1], rows[j + 1]);
            add({first, first + 1, first + width}, {a, b, c});
            add({first + 1, first + width + 1, first + width}, {b, d, c});
        }
    }
    auto mesh = std::make_shared<Mesh>();
    RTCGeometry geometry = rtcNewGeometry(mesh->of.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices =
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry,
                                                    RTC_BUFFER_TYPE_VERTEX,
                                                    0,
                                                    RTC_FORMAT_FLOAT3,
                                                    3 * sizeof(float),
                                                    columns.size() * rows.size()));
    auto* const corners =
        static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry,
                                                       RTC_BUFFER_TYPE_INDEX,
                                                       0,
                                                       RTC_FORMAT_UINT3,
                                                       3 * sizeof(unsigned),
                                                       std::max<std::size_t>(1, triangles.size())));
    std::size_t n = 0;
    for (const int row : rows) {
        for (const int column : columns) {
            const Eigen::Vector3f& point_m = relief.point_m[relief.at(column, row)];
            for (int k = 0; k < 3; ++k) vertices[n++] = point_m(k);
        }
    }
    n = 0;
    if (triangles.empty()) triangles.push_back({0, 0, 0});  // of no area
    for (const auto& triangle : triangles)
        for (const unsigned corner : triangle) corners[n++] = corner;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(mesh->scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(mesh->scene.get());
    mesh_ = std::move(mesh);
}

bool ReliefShadow::hides(std::size_t pixel, const Eigen::Vector3d& lamp_m) const {
    const Eigen::Vector3f& point_m = relief_.point_m[pixel];
    const float bias_m = static_cast<float>(kShadowBias) * point_m.norm();
    const Eigen::Vector3f from_m = point_m + bias_m * relief_.normal[pixel];
    const Eigen::Vector3f way = lamp_m.cast<float>() - from_m;
    RTCRay ray{};
    ray.org_x = from_m.x();
    ray.org_y = from_m.y();
    ray.org_z = from_m.z();
    ray.dir_x = way.x();
    ray.dir_y = way.y();
    ray.dir_z = way.z();
    ray.tnear = bias_m / way.norm();
    ray.tfar = 1.0F;
    ray.mask = ~0U;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(mesh_->scene.get(), &context, &ray);
    return ray.tfar < 0.0F;
}

}  // namespace aphotic
