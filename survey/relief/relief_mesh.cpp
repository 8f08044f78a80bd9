// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/relief_mesh.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "image/image_size.h"
#include "light/triangle_mesh.h"
#include "rig/file/mesh_reader.h"
#include "survey/relief/ply_mesh.h"

#include <cmath>
#include <string>
#include <vector>

namespace aphotic {
namespace {

constexpr std::size_t kMostReliefFile_bytes = 2048 * kMebibyte;

// For the most that the heights could make, even if some are unknown.
void require_room(const HeightGrid& grid) {
    const std::size_t triangles = 2 * size_of(grid.width) * size_of(grid.height);
    if (triangles <= kMostReliefTriangles) return;
    throw InputError(
        "found {} x {} heights; allowed: {} in all: cut out a part (`gdalwarp -te`) or use "
        "larger cells (`gdalwarp -tr`)",
        grid.width,
        grid.height,
        kMostReliefTriangles / 2);
}

}  // namespace

Mesh mesh_of(const HeightGrid& grid) {
    require_room(grid);
    Mesh mesh;
    std::vector<int> vertices;  // by sample; -1: unknown
    vertices.reserve(grid.height_m.size());
    for (int row = 0; row < grid.height; ++row) {
        for (int column = 0; column < grid.width; ++column) {
            const float height_m = grid.height_m[vertices.size()];
            const bool is_known = std::isfinite(height_m);
            vertices.push_back(is_known ? static_cast<int>(mesh.vertices_m.size()) : -1);
            if (is_known)
                mesh.vertices_m.emplace_back(grid.east_m + column * grid.step_east_m,
                                             grid.north_m - row * grid.step_south_m,
                                             height_m);
        }
    }
    mesh.triangles = grid_triangles(vertices, size_of(grid.width));
    if (mesh.triangles.empty())
        throw InputError(
            "found no three adjacent known heights in a grid of {} x {}; allowed: at least one "
            "triangle",
            grid.width,
            grid.height);
    return mesh;
}

Mesh read_relief_mesh(const std::filesystem::path& file) {
    const std::string name = file.string();
    const std::string extension = lower_case(file.extension().string());
    if (extension == ".ply")
        return parse_ply(name, read_text_file(file, kMostReliefFile_bytes), kMostReliefTriangles);
    if (extension == ".obj")
        return parse_obj(name, read_text_file(file, kMostReliefFile_bytes), kMostReliefTriangles);
    if (extension == ".tif" || extension == ".tiff") {
        const HeightGrid grid = read_height_grid(file);
        return naming(name, [&] { return mesh_of(grid); });
    }
    throw InputError(
        "{}: found the extension '{}'; allowed: .ply, .obj, .tif, .tiff", name, extension);
}

}  // namespace aphotic
