// SPDX-License-Identifier: BSD-3-Clause
#include "light/relief_shadow.h"

#include <algorithm>
#include <array>
#include <vector>

namespace aphotic {

namespace {

// Between known places only.
std::vector<std::array<unsigned, 3>> triangles_of(const Relief& relief,
                                                  const std::vector<int>& columns,
                                                  const std::vector<int>& rows) {
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
    return triangles;
}

TriangleMesh mesh_of(const Relief& relief, int step_px) {
    const std::vector<int> columns = every(step_px, relief.width_px);
    const std::vector<int> rows = every(step_px, relief.height_px);
    std::vector<Eigen::Vector3f> vertices_m;
    for (const int row : rows)
        for (const int column : columns)
            vertices_m.push_back(relief.point_m[relief.at(column, row)]);
    return {vertices_m, triangles_of(relief, columns, rows)};
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
