// SPDX-License-Identifier: BSD-3-Clause
#include "light/relief_shadow.h"

#include <vector>

namespace aphotic {

namespace {

// Between known places only.
TriangleMesh mesh_of(const Relief& relief, int step_px) {
    const std::vector<int> columns = every(step_px, relief.width_px);
    std::vector<Eigen::Vector3f> vertices_m;
    std::vector<int> vertices;  // by place
    for (const int row : every(step_px, relief.height_px)) {
        for (const int column : columns) {
            const std::size_t pixel = relief.at(column, row);
            vertices.push_back(relief.knows(pixel) ? static_cast<int>(vertices_m.size()) : -1);
            if (relief.knows(pixel)) vertices_m.push_back(relief.point_m[pixel]);
        }
    }
    return {vertices_m, grid_triangles(vertices, columns.size())};
}

}  // namespace

ReliefShadow::ReliefShadow(const Relief& relief)
    : relief_(relief),
      step_px_((relief.width_px + kShadowMesh_px - 1) / kShadowMesh_px),
      mesh_(mesh_of(relief, step_px_)) {}

bool ReliefShadow::hides(std::size_t pixel, const Eigen::Vector3d& lamp_m) const {
    const Eigen::Vector3f& point_m = relief_.point_m[pixel];
    const float bias_m = static_cast<float>(kShadowBias) * point_m.norm();
    const Eigen::Vector3f from_m = point_m + bias_m * relief_.normal[pixel];
    const Eigen::Vector3f way = lamp_m.cast<float>() - from_m;
    return mesh_.blocks(from_m, way, bias_m / way.norm());
}

}  // namespace aphotic
