// SPDX-License-Identifier: BSD-3-Clause
//
// The floor of a whole survey from one file, in a frame of the survey's own:
//
//   .ply   triangles (ply_mesh.h)             Metashape, CloudCompare, MeshLab
//   .obj   triangles (mesh_reader.h)
//   .tif   heights on a grid (height_grid.h)  MB-System, GMT, QGIS
//
// A grid gives two triangles for each four neighbouring samples that are known, with x east, y
// north and the file's values as z.
#pragma once

#include "image/height_grid.h"
#include "rig/rig.h"

#include <cstddef>
#include <filesystem>

namespace aphotic {

// They take some 150 bytes each.
inline constexpr std::size_t kMostReliefTriangles = 20'000'000;

// An InputError, which names the file.
[[nodiscard]] Mesh read_relief_mesh(const std::filesystem::path& file);

[[nodiscard]] Mesh mesh_of(const HeightGrid& grid);

}  // namespace aphotic
