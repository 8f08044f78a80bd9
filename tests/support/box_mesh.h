// SPDX-License-Identifier: BSD-3-Clause
//
// A box as a mesh of twelve triangles.
#pragma once

#include "rig/rig.h"

namespace aphotic {

inline Mesh mesh_of(const Box& box) {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        const auto pick = [&](int axis) {
            return (corner >> axis & 1) == 0 ? box.least_m(axis) : box.most_m(axis);
        };
        mesh.vertices_m.emplace_back(pick(0), pick(1), pick(2));
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int u = 1 << ((axis + 1) % 3);
        const int v = 1 << ((axis + 2) % 3);
        for (const int side : {0, 1 << axis}) {
            mesh.triangles.push_back({side, side + u, side + v});
            mesh.triangles.push_back({side + u + v, side + u, side + v});
        }
    }
    return mesh;
}

}  // namespace aphotic
