// SPDX-License-Identifier: BSD-3-Clause
//
// Reads a triangle mesh from the text of a Wavefront OBJ file: lines "v x y z", metres in the sled
// frame (x forward, y starboard, z down), and lines "f a b c ...", whose polygons are cut into
// triangles from one corner, which must see all others; quadrilaterals along the shorter diagonal.
// Groups, materials, normals and texture coordinates are ignored: an object has one material and
// flat faces.
//
// position_m is added to every vertex. The sum is rounded to single precision, 0.1 um at 2 m, as
// POV-Ray stores mesh vertices, so that both renderers see the same ones.
//
// An error is an InputError that begins with the file and, if known, the line.
#pragma once

#include "rig/rig.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kMostTriangles = 1'000'000;

// The limit per polygon: the time for cutting grows at least with the square of their number.
inline constexpr std::size_t kMostCorners = 256;

// A triangle whose height is below this share of its longest side has no plane in single precision.
inline constexpr double kLeastTriangleHeight = 1e-6;

inline constexpr std::size_t kMostMeshBytes = std::size_t{256} << 20U;

// file_name is for messages.
[[nodiscard]] Mesh parse_mesh(const std::string& file_name,
                              const std::string& obj,
                              const Eigen::Vector3d& position_m);

// The same for a survey's mesh: vertices unchanged, in any frame, and triangles without area
// included.
[[nodiscard]] Mesh parse_obj(const std::string& file_name,
                             const std::string& obj,
                             std::size_t most_triangles);

// Cuts a polygon into triangles from one corner to the others: a corner that sees them all, so that
// all triangles have the same orientation, and of these the one with the shortest diagonals.
// Triangles without area are omitted. Empty if no corner sees all others.
[[nodiscard]] std::vector<std::array<int, 3>> cut(const Mesh& mesh, std::vector<int> corners);

}  // namespace aphotic
