// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's mesh from any bytes.
#include "fuzz.h"
#include "survey/relief/ply_mesh.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kMostTriangles = 1000;
    aphotic::expect_result_or_placed_error("mesh.ply", [&] {
        const aphotic::Mesh mesh =
            aphotic::parse_ply("mesh.ply", aphotic::text_of(data, size), kMostTriangles);
        for (const auto& corners : mesh.triangles) {
            for (const int corner : corners)
                static_cast<void>(mesh.vertices_m.at(static_cast<std::size_t>(corner)));
        }
    });
    return 0;
}
