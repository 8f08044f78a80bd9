// SPDX-License-Identifier: BSD-3-Clause
//
// A mesh from a PLY file (G. Turk, The PLY Polygon File Format, 1994), ascii or binary and
// little-endian, as Metashape, CloudCompare, MeshLab and Open3D write them:
//
//   vertex   with x, y and z of any type of number, among others
//   face     with the list vertex_indices or vertex_index; polygons are cut (mesh_reader.h)
//
// Other elements and properties are skipped.
#pragma once

#include "rig/rig.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace aphotic {

// name is for messages. An InputError if it is not a PLY file, is truncated, or has no triangles or
// too many.
[[nodiscard]] Mesh parse_ply(const std::string& name,
                             std::string_view ply,
                             std::size_t most_triangles);

}  // namespace aphotic
